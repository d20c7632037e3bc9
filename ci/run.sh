#!/usr/bin/env bash
# Every gate that a change must pass, each with its name and time. The last line is "N passed, M failed": the tests one
# by one, every other gate as one.
set -euo pipefail
# shellcheck source=scripts/lib.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../scripts/lib.sh"

all_passed=0 all_failed=0
summary=()
log=$(mktemp)
trap 'rm -f -- "$log"' EXIT

# gate NAME COMMAND...: the command, from the workspace; one that ends with "N passed, M failed" counts as that many.
gate() {
    local name=$1 start=$SECONDS code=0 passed failed verdict=passed
    shift
    printf '\n=== %s\n' "$name"
    "$@" </dev/null 2>&1 | tee -- "$log" || code=$?
    if ! set_counts "$(tail -n 1 -- "$log")"; then
        passed=$((code == 0)) failed=$((code != 0))
    elif ((code && !failed)); then
        failed=1
    fi
    ((failed == 0)) || verdict=FAILED
    ((all_passed += passed, all_failed += failed, 1))
    summary+=("$(printf '%-8s %-32s %4d passed %4d failed %5d s' "$verdict" "$name" "$passed" "$failed" $((SECONDS - start)))")
    printf '=== %s: %s, %d s\n' "$name" "$verdict" $((SECONDS - start))
}

# shellcheck disable=SC2317  # called through gate
scripts_are_sound() {
    local files=(scripts/* ci/run.sh ci/language ci/count-words .ci/run) file
    for file in "${files[@]}"; do
        bash -n "$file" || return
    done
    if command -v shellcheck >/dev/null; then
        shellcheck --external-sources "${files[@]}"
    else
        echo "shellcheck is not installed: syntax only"
    fi
}

# rustfmt leaves comments as they are.
# shellcheck disable=SC2317
is_formatted() {
    cargo fmt --all --check || return
    ! LC_ALL=C.UTF-8 git grep -nE '^.{121,}$' -- '*.rs' | grep -E '^[^:]*:[0-9]+: *//'
}

# An operation between lanes that the compiler leaves out of the function with the wide vectors is a call through
# memory.
# shellcheck disable=SC2317
lanes_are_inlined() {
    local symbols
    build_programs
    symbols=$(nm --demangle -- "$solver") || return
    if ! grep -q 'vectorize_' <<<"$symbols"; then
        echo "no function with wide vectors: what is looked for may have another name"
        return 1
    fi
    ! grep __fearless_simd_kernel <<<"$symbols"
}

cd -- "$root"
export CARGO_TERM_COLOR=never
# Nothing here is compiled a second time after a change.
export CARGO_INCREMENTAL=0
gate "setup" scripts/setup
gate "lock file" cargo tree --locked --workspace --depth 0 --quiet
gate "scripts" scripts_are_sound
gate "format" is_formatted
gate "language" ci/language
gate "words" ci/count-words --most 60000
gate "clippy" cargo clippy --workspace --all-targets -- -D warnings
RUSTDOCFLAGS='-D warnings' gate "docs" cargo doc --workspace --no-deps --lib
gate "tests" scripts/test
# `--check` builds no HTML, because compiling mdBook and mdbook-katex takes minutes. After a change of equations or of the
# layout, run scripts/book.
gate "book" scripts/book --check
gate "short cases, golden curves" scripts/golden --check
gate "lanes" lanes_are_inlined
gate "validation, short" scripts/validate --short
gate "extremes, short" scripts/extremes --short
gate "faults, short" scripts/faults --short

printf '\n'
printf '%s\n' "${summary[@]}"
printf '%d passed, %d failed\n' "$all_passed" "$all_failed"
((all_failed == 0))
