//! The `planish` command line: renders, dumps, describes and times subdivision surfaces.
//!
//! | module | idea |
//! |---|---|
//! | `args` | every flag, once |
//! | `names`, `values`, `frames`, `aov` | what a flag's value means |
//! | `console` | standard output and standard error |
//! | `cage` | a scene file, and what its mesh is like |
//! | `displacement` | the displacement maps of a scene's meshes |
//! | `offline` | device, surface and passes: the machinery that the commands share |
//! | `shading` | materials and lights of a scene, and frames shaded by them |
//! | `image` | a frame's images, read back |
//! | `stats` | the JSON of `--stats` |
//! | `table_cache` | tables that were made before |
//! | `render`, `dump`, `compare`, `info`, `bench`, `devices` | the commands |

mod aov;
mod args;
mod bench;
mod cage;
mod compare;
mod console;
mod culling;
mod devices;
mod displacement;
mod dump;
mod frames;
mod image;
mod info;
mod interrupt;
mod mattes;
mod moment;
mod names;
mod offline;
mod progress;
mod render;
mod sampling;
mod scene_info;
mod shading;
mod split;
mod stats;
mod table_cache;
mod text_table;
mod values;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};
use console::Console;

/// Exit status of a command that failed.
const FAILED: u8 = 1;
/// Exit status of a command line that makes no sense.
const WRONG_USAGE: u8 = 2;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) if error.use_stderr() => {
            console::print_error(&args::usage_error(&error));
            return ExitCode::from(WRONG_USAGE);
        }
        Err(help) => {
            // A reader of the help that has gone away is no failure.
            let _ = help.print();
            return ExitCode::SUCCESS;
        }
    };
    let console = Console::new(&arguments.console);
    let done = match &arguments.command {
        Command::Render(arguments) => render::run(arguments, &console),
        Command::Dump(arguments) => dump::run(arguments, &console),
        Command::Compare(arguments) => compare::run(arguments, &console),
        Command::Info(arguments) => info::run(arguments, &console),
        Command::Bench(arguments) => bench::run(arguments, &console),
        Command::Devices => devices::run(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if console::is_closed_output(&error) => ExitCode::SUCCESS,
        Err(error) => {
            console.end_progress();
            console::print_error(&console::error_text(&error));
            ExitCode::from(if error.is::<console::WrongUsage>() { WRONG_USAGE } else { FAILED })
        }
    }
}
