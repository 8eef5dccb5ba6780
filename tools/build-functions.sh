# shellcheck shell=bash
# shellcheck disable=SC2154  # root comes from the script that sources this
# Sourced by run and check: the environment of builds and runs, and one build step. Wants $root.

# Objects are found again after the tree moved or was cloned anew.
export CCACHE_BASEDIR=$root
export CCACHE_NOHASHDIR=1
export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-time_macros,pch_defines}

# All cores for builds and tests. Asked before OMP_NUM_THREADS is set, because nproc obeys it.
n_cores=$(env -u OMP_NUM_THREADS nproc)

# Open MPI refuses root, and more ranks than cores, unless told; Kokkos' threads would fight the ranks.
if ((EUID == 0)); then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
export OMPI_MCA_rmaps_base_oversubscribe=1
export OMP_NUM_THREADS=${OMP_NUM_THREADS:-1}

# build PRESET TARGET...: configures build/PRESET where needed and builds; silent when all is current.
build() {
  local preset=$1 directory=$root/build/$1 log=$root/build/configure-$1.log processor
  shift
  # -march=native means something else on another processor (a build folder kept by a CI service).
  processor=$(g++ -march=native -Q --help=target 2> /dev/null | md5sum)
  if [[ -f $directory/CMakeCache.txt ]] &&
     ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$directory/CMakeCache.txt"; then
    echo "The tree has moved: configuring build/$preset anew."
    rm -rf "$directory"
  fi
  if [[ ! -f $directory/build.ninja || $(cat "$directory/processor" 2> /dev/null) != "$processor" ]]; then
    echo "Configuring build/$preset ..."
    mkdir -p "$root/build"
    if ! (cd "$root" && cmake --preset "$preset") > "$log" 2>&1; then
      cat "$log" >&2
      return 1
    fi
    echo "$processor" > "$directory/processor"
  fi
  # Looking up the commit runs in every build and "no work" is no news: both unsaid.
  cmake --build "$directory" -j "$n_cores" --target "$@" |
    { grep --line-buffered -v -e git_hash -e 'no work to do' || true; }
}
