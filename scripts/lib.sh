# shellcheck shell=bash disable=SC2034  # the names that are set here are read by the scripts
# What the scripts share: where things are, building, launching on ranks, counting. Sourced, never run.

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd -P)

# A shell that has not been opened again since Rust came does not know it yet.
command -v cargo >/dev/null || PATH="$PATH:${CARGO_HOME:-${HOME:-}/.cargo}/bin"

say() {
    printf '%s\n' "$*" >&2
}

die() {
    say "${0##*/}: $*"
    exit 1
}

# build_in TREE ARGUMENTS...: cargo with the arguments in a work tree; prints the path of each executable that it made.
build_in() {
    local tree=$1 messages
    shift
    messages=$(cd -- "$tree" && cargo "$@" --message-format=json-render-diagnostics </dev/null) || return
    sed -n 's/.*"executable":"\([^"]*\)".*/\1/p' <<<"$messages"
}

# build ARGUMENTS...: the same in the workspace.
build() {
    build_in "$root" "$@"
}

# build_programs: both programs, optimised; sets `solver` and `companion`.
build_programs() {
    local built
    built=$(build build --release --package bsmpm-par --package bsmpm-tools --bins) || die "the build failed"
    solver=$(grep '/bsmpm-par$' <<<"$built") || die "cargo built no bsmpm-par"
    companion=$(grep '/bsmpm$' <<<"$built") || die "cargo built no bsmpm"
}

# solver_of COMMIT: the solver of a commit, built in a work tree of its own under target/commits unless that was done before; of
# `.` that of the working tree. Prints its path.
solver_of() {
    local sha tree built made=$root/target/commits
    if [[ $1 == . ]]; then
        build build --release --package bsmpm-par --bins | grep '/bsmpm-par$' && return
    fi
    sha=$(git -C "$root" rev-parse --short "$1^{commit}") || return
    tree=$made/tree
    if [[ ! -x $made/bsmpm-par-$sha ]]; then
        rm -rf -- "$tree"
        git -C "$root" worktree prune
        mkdir -p -- "$made"
        git -C "$root" worktree add --quiet --force --detach "$tree" "$sha" >&2 || return
        built=$(CARGO_TARGET_DIR=$made/build build_in "$tree" build --release --package bsmpm-par --bins) || return
        cp -- "$(grep '/bsmpm-par$' <<<"$built")" "$made/bsmpm-par-$sha" || return
        git -C "$root" worktree remove --force "$tree"
    fi
    printf '%s\n' "$made/bsmpm-par-$sha"
}

# default NAME VALUE: an environment variable, unless the caller has set it.
default() {
    export "$1=${!1-$2}"
}

# cores: the number of cores that a program may use; nproc alone would give the number of threads that OMP_NUM_THREADS asks for.
cores() {
    env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc
}

# mpi_environment RANKS: what MPI needs to start so many ranks anywhere; also for programs that start mpirun themselves.
mpi_environment() {
    # The ranks are the parallelism: no threads in BLAS besides.
    export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
    if ((EUID == 0)); then
        export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    fi
    # The program says itself why it ends; mpirun need not add its own page.
    default OMPI_MCA_orte_execute_quiet 1
    # In a Slurm job the site decides on placement and transport.
    [[ -z ${SLURM_JOB_ID-} ]] || return 0
    # More ranks than cores, and several runs side by side: no ranks bound to the same cores.
    default OMPI_MCA_rmaps_base_oversubscribe 1
    default PRTE_MCA_rmaps_default_mapping_policy :oversubscribe
    default OMPI_MCA_hwloc_base_binding_policy none
    # Busy waiting is the fastest where every rank has a core, and the slowest where it has not.
    (($1 <= $(cores))) || default OMPI_MCA_mpi_yield_when_idle 1
    # One machine: shared memory only, without the system call that containers forbid.
    default OMPI_MCA_pml ob1
    default OMPI_MCA_btl self,vader
    default OMPI_MCA_btl_vader_single_copy_mechanism none
}

# launch RANKS PROGRAM ARGUMENTS...: the program on that many ranks; its exit code.
launch() {
    local ranks=$1
    shift
    mpi_environment "$ranks"
    mpirun -n "$ranks" "$@" </dev/null
}

# set_counts LINE: `passed` and `failed` from a line "N passed, M failed"; false for any other line.
set_counts() {
    [[ $1 =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]] || return 1
    passed=${BASH_REMATCH[1]} failed=${BASH_REMATCH[2]}
}

# parse_publish ARGUMENTS...: takes --publish out of the arguments of a script: sets `publishing` (yes or empty) and `arguments`
# (the others).
parse_publish() {
    local argument
    publishing='' arguments=()
    for argument in "$@"; do
        if [[ $argument == --publish ]]; then publishing=yes; else arguments+=("$argument"); fi
    done
}

# measured_by: when, on which commit, by which command and where something was measured; `arguments` are those of the script.
# What is changed in the documentation alone is no change of the commit.
measured_by() {
    local commit changes='' command processor
    commit=$(git -C "$root" rev-parse --short=8 HEAD) || return
    git -C "$root" diff --quiet HEAD -- . ':!*.md' ':!*.png' || changes=' with uncommitted changes'
    command=${0##*/}
    ((${#arguments[@]} == 0)) || command+=$(printf ' %q' "${arguments[@]}")
    processor=$(sed -n 's/^model name[[:space:]]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1)
    printf "Measured on %s at commit %s%s,\nby \`scripts/%s\`, on %s cores (%s).\n" "$(date +%F)" "$commit" "$changes" \
        "$command" "$(cores)" "${processor:-unknown processor}"
}

# processor_time: time of the processors in use, and of all processors, in ticks.
processor_time() {
    awk '/^cpu / { for (k = 2; k <= NF; k++) all += $k; print all - $5 - $6, all }' /proc/stat
}

# require_idle: ends the script if other programs use the processors. Times that are measured beside them mean nothing.
require_idle() {
    local before after used
    before=$(processor_time)
    sleep 2
    after=$(processor_time)
    used=$(awk '{ printf "%d", 100 * ($3 - $1) / ($4 - $2) }' <<<"$before $after")
    ((used < 10)) || die "other programs use $used % of the processors, so that measured times would mean nothing. Stop these programs"
}

# publish NAME TITLE TEXT TABLES: writes the page verification/NAME.md of the book: the title, the text that says what is measured
# and how to read it, when and where it was measured, and the file TABLES. A page that is there stays if there are none.
publish() {
    local page=$root/crates/bsmpm-book/src/verification/$1.md origin
    [[ -s $4 ]] || { say "${0##*/}: no results in $4, ${page#"$root"/} stays as it is" && return 1; }
    origin=$(measured_by) || return
    mkdir -p -- "${page%/*}"
    {
        printf '<!-- Generated by scripts/%s --publish; do not edit. -->\n# %s\n\n%s\n\n%s\n' "${0##*/}" "$2" "$3" "$origin" &&
            { [[ " ${arguments[*]} " != *' --short '* ]] ||
                printf '\nThis is the short version: coarse grids or few cases, which take minutes. The full version takes hours.\n'; } &&
            printf '\n' && cat -- "$4"
    } >"$page.new" || return
    mv -- "$page.new" "$page"
    say "${0##*/}: wrote ${page#"$root"/}"
}

# publish_pictures FILE...: copies pictures to where the pages of the book show them, as ../pictures/verification/.
publish_pictures() {
    local pictures=$root/crates/bsmpm-book/src/pictures/verification
    mkdir -p -- "$pictures"
    (($# == 0)) || cp -- "$@" "$pictures"
}

# sweep_pictures PREFIX DIRECTORY CAPTION: publishes the pictures of a `bsmpm sweep` there under names with a prefix, and prints
# what shows them on a page.
sweep_pictures() {
    local prefix=$1 directory=$2 caption=$3 picture name pictures=$root/crates/bsmpm-book/src/pictures/verification
    mkdir -p -- "$pictures"
    for picture in "$directory"/sweep*.png; do
        [[ -e $picture ]] || continue
        name=$prefix${picture##*/sweep}
        cp -- "$picture" "$pictures/$name" || return
        printf '![%s](../pictures/verification/%s)\n\n' "$caption" "$name"
    done
}
