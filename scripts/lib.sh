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
    (($1 <= $(nproc))) || default OMPI_MCA_mpi_yield_when_idle 1
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
