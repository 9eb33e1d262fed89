//! Tables that are kept for another run: the same triangles, byte for byte, whatever has become of them.

use std::fs;
use std::path::{Path, PathBuf};

use planish_tests::folder::{contents, temporary};
use planish_tests::parallel::check_all;
use planish_tests::ply::Dump;
use planish_tests::program::{Outcome, Planish};
use planish_tests::repository::{scene, scheme_scene};

/// What becomes of a file's bytes.
type Spoil<'a> = &'a dyn Fn(&[u8]) -> Vec<u8>;
/// Configurations read and built, and the dump's triangles.
type Run = (u64, u64, Vec<u8>);

fn counts(outcome: &Outcome) -> Result<(u64, u64), String> {
    let stats = outcome.json()?;
    let count =
        |name: &str| stats["table_configurations"][name].as_u64().ok_or_else(|| outcome.told("expected counts"));
    Ok((count("read")?, count("built")?))
}

/// Dumps by table, with tables kept in a folder if there is one.
fn dump(mesh: &Path, flags: &str, kept: Option<&Path>) -> Result<Run, String> {
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    let command = Planish::dump(mesh, &path).flags("--method table --tess 5.3 --stats -").flags(flags);
    let command = command.flags("--table-cache").path(kept.unwrap_or(Path::new("none")));
    let (read, built) = counts(&command.run().silent_success()?)?;
    Ok((read, built, Dump::read(&path)?.sorted_triangles()))
}

fn cases() -> Vec<(PathBuf, &'static str)> {
    let loops = ["loop", "loop-stam", "butterfly"].map(|scheme| (scheme_scene("loop_valences"), scheme));
    let others = [(scheme_scene("stam_mixed"), "loop-stam"), (scheme_scene("loop_creased"), "loop")];
    let quads = ["ngon_5", "chaikin_2_3", "boundary_edge_only"].map(|name| (scene(name), "catmull-clark"));
    loops.into_iter().chain(others).chain(quads).collect()
}

#[test]
fn a_second_run_reads_what_the_first_built_and_dumps_the_same_triangles() {
    // One folder for all: no scheme reads another's.
    let shared = temporary();
    check_all(&cases(), |(mesh, scheme)| {
        let (flags, own) = (format!("--scheme {scheme}"), temporary());
        let (_, count, expected) = dump(mesh, &flags, None)?;
        let runs = [(own.path(), 0, count), (own.path(), count, 0)];
        for (folder, read, built) in runs {
            let found = dump(mesh, &flags, Some(folder))?;
            if found != (read, built, expected.clone()) {
                let counts = format!("{} read, {} built, expected {read} and {built}", found.0, found.1);
                return Err(format!("{} {flags}: {counts}, same triangles: {}", mesh.display(), found.2 == expected));
            }
        }
        let of_all = dump(mesh, &flags, Some(shared.path()))?;
        if of_all.2 == expected { Ok(()) } else { Err(format!("{} {flags}: another dump", mesh.display())) }
    });
}

#[test]
fn spoilt_files_are_built_and_written_anew() {
    let (mesh, folder) = (scheme_scene("loop_valences"), temporary());
    let (_, count, expected) = dump(&mesh, "--scheme loop", Some(folder.path())).unwrap();
    let whole = contents(folder.path());
    assert_eq!(whole.len() as u64, count);
    let other = whole.values().next().unwrap().clone();
    let spoils: [(&str, Spoil); 6] = [
        ("empty", &|_| Vec::new()),
        ("cut off in the head", &|bytes| bytes[..20].to_vec()),
        ("cut off", &|bytes| bytes[..bytes.len() - 1].to_vec()),
        ("too long", &|bytes| [bytes, b"\n"].concat()),
        ("another's", &|bytes| if bytes == other { b"PLTABLE1".to_vec() } else { other.clone() }),
        ("of a turned bit", &|bytes| {
            let mut turned = bytes.to_vec();
            turned[bytes.len() / 2] ^= 1;
            turned
        }),
    ];
    for (what, spoil) in spoils {
        whole.iter().for_each(|(path, bytes)| fs::write(path, spoil(bytes)).unwrap());
        assert_eq!(dump(&mesh, "--scheme loop", Some(folder.path())).unwrap(), (0, count, expected.clone()), "{what}");
        assert!(contents(folder.path()) == whole, "{what}");
    }
    fs::remove_file(whole.keys().next().unwrap()).unwrap();
    assert_eq!(dump(&mesh, "--scheme loop", Some(folder.path())).unwrap(), (count - 1, 1, expected));
}

#[test]
fn runs_that_share_an_empty_folder_make_the_same_surface() {
    let (mesh, folder) = (scheme_scene("loop_valences"), temporary());
    let (_, count, expected) = dump(&mesh, "--scheme butterfly", None).unwrap();
    check_all(&[0; 6], |_| {
        let (read, built, found) = dump(&mesh, "--scheme butterfly", Some(folder.path()))?;
        if read + built == count && found == expected { Ok(()) } else { Err(format!("{read} read, {built} built")) }
    });
    // No temporary file is left.
    assert_eq!(contents(folder.path()).len() as u64, count);
}

#[test]
fn a_folder_that_cannot_be_written_to_is_told_once_and_no_failure() {
    let (mesh, folder) = (scene("cube"), temporary());
    let (file, out) = (folder.path().join("file"), folder.path().join("dump.ply"));
    fs::write(&file, "").unwrap();
    let run = |path: &Path| Planish::dump(&mesh, &out).flags("--method table --tess 3 --table-cache").path(path).run();
    let outcome = run(&file.join("below"));
    assert!(outcome.status.success(), "{outcome:?}");
    let warning =
        outcome.stderr.strip_prefix("planish: warning: tables are not kept: cannot make ").expect("a warning");
    assert_eq!(warning.lines().count(), 1, "{warning}");
    let triangles = Dump::read(&out).unwrap().sorted_triangles();
    run(Path::new("none")).silent_success().unwrap();
    assert!(Dump::read(&out).unwrap().sorted_triangles() == triangles);
    // The user's own folder is not insisted on.
    let info = |name: &str| Planish::info(&mesh).flags("--method table --tess 3").keeping_tables().env(name, &file);
    info("XDG_CACHE_HOME").run().silent_success().unwrap();
}

#[test]
fn tables_are_kept_in_the_user_s_cache_unless_that_is_turned_off() {
    let (mesh, folder) = (scene("cube"), temporary());
    let info = |flags: &str| {
        let command = Planish::info(&mesh).flags(flags).keeping_tables();
        let outcome = command.env("XDG_CACHE_HOME", "").env("HOME", folder.path()).run().silent_success().unwrap();
        let basis = outcome.json().unwrap()["refinement"]["basis"].clone();
        (basis["read"].as_u64(), basis["built"].as_u64(), contents(folder.path()).len() as u64)
    };
    assert_eq!(info("--method dfas --tess 3"), (None, None, 0));
    let (read, built, count) = info("--method table --tess 3 --table-cache none");
    assert_eq!((read, count), (Some(0), 0));
    assert_eq!(info("--method table --tess 3"), (Some(0), built, built.unwrap()));
    assert_eq!(info("--method table --tess 3"), (built, Some(0), built.unwrap()));
    assert!(contents(folder.path()).keys().all(|path| path.starts_with(folder.path().join(".cache/planish/tables"))));
}
