# shellcheck shell=bash
# Sourced by the scripts beside it: where the repository and its build products are.

repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# rustup's own place for cargo is not on the path of every non-interactive shell.
PATH="$PATH:${CARGO_HOME:-${HOME:-/root}/.cargo}/bin"
export PATH

# As cargo, started in the repository, would resolve it.
# shellcheck disable=SC2034
target=$(cd "$repo" && realpath -m "${CARGO_TARGET_DIR:-target}")
