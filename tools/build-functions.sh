# shellcheck shell=bash
# shellcheck disable=SC2154  # root comes from the script that sources this
# Sourced by run, check and tools/set-up: the environment of builds and runs, one build step, how far it and apt-get are. Wants $root.

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
# Open MPI's hwloc would ask X servers for graphics cards, and complain where one does not know us.
export HWLOC_COMPONENTS=${HWLOC_COMPONENTS:--gl}
export OMP_NUM_THREADS=${OMP_NUM_THREADS:-1}

# Core-minutes of a build without a compiler cache: of simulate, and of what ./check builds besides (docs/contributing.md).
core_minutes_of_programs=12
core_minutes_of_tests=11

# Says how long the first build will take here; nothing after it.
say_build_time() {
  [[ ! -f $root/build/release/.ninja_log ]] || return 0
  printf 'The first build takes about %d min for ./run, %d min for ./check on %d cores like those of 2026; later ones are short.\n' \
    $((1 + core_minutes_of_programs / n_cores)) \
    $((1 + (core_minutes_of_programs + core_minutes_of_tests) / n_cores)) "$n_cores"
}

# Says every ten seconds how far ninja is and how long it will take; passes on what is no progress.
# Steps are unlike each other, so the time that is left is a guess.
show_progress() {
  local line finished all seconds=0 left said=0
  while IFS= read -r line; do
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\ ([0-9]+)[0-9.]*\]\  ]]; then
      finished=${BASH_REMATCH[1]} all=${BASH_REMATCH[2]} seconds=${BASH_REMATCH[3]}
      if ((seconds >= said + 10 && finished < all)); then
        said=$seconds left=$((seconds * (all - finished) / finished))
        printf '  %d of %d steps, %d:%02d min, about %d:%02d to go\n' "$finished" "$all" \
          $((seconds / 60)) $((seconds % 60)) $((left / 60)) $((left % 60))
      fi
    elif [[ $line != *'no work to do'* ]]; then
      printf '%s\n' "$line"
    fi
  done
  if ((seconds >= 10)); then printf '  the build took %d:%02d min\n' $((seconds / 60)) $((seconds % 60)); fi
}

# Passes lines on with the seconds since the first of them before each.
with_seconds() {
  local line began=''
  while IFS= read -r line; do
    began=${began:-$SECONDS}
    printf '%d %s\n' $((SECONDS - began)) "$line"
  done
}

# Says every ten seconds how far apt-get is and how long it will take, from the lines of its status descriptor with seconds before
# each: dlstatus:...:PERCENT:WORDS, of the bytes, and pmstatus:..., of the packages' steps. Each stage is as fast as it was until
# now; how fast packages are unpacked nobody knows before the first.
show_packages() {
  local seconds line stage='' done_tenths began=0 said=0 first=0 left words
  while read -r seconds line; do
    [[ $line =~ ^(dl|pm)status:[^:]*:([0-9]+)(\.([0-9]))?[0-9]*: ]] || continue
    done_tenths=$((10 * BASH_REMATCH[2] + ${BASH_REMATCH[4]:-0}))
    if [[ ${BASH_REMATCH[1]} != "$stage" ]]; then
      stage=${BASH_REMATCH[1]} began=$seconds first=$done_tenths
    fi
    ((seconds >= said + 10)) || continue
    said=$seconds left='' words=installed
    if ((done_tenths > first)); then
      left=$(((seconds - began) * (1000 - done_tenths) / (done_tenths - first)))
      left=$(printf ', about %d:%02d to go' $((left / 60)) $((left % 60)))
    fi
    if [[ $stage == dl ]]; then words=fetched left+=', then they are installed'; fi
    printf '  %s %d %%%s\n' "$words" $((done_tenths / 10)) "$left"
  done
}

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
  NINJA_STATUS='[%f/%t %e] ' cmake --build "$directory" -j "$n_cores" --target "$@" | show_progress
}
