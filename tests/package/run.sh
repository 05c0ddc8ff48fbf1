#!/bin/sh
# Builds and runs a stranger's project against an installed hbar: run.sh BUILD SCRATCH
#
# BUILD is a built hbar, SCRATCH a folder that is emptied first.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=$1
scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch"

# Installed, and then moved: a package does not know where it was built.
cmake --install "$build" --prefix "$scratch/elsewhere" >"$scratch/install.log"
mv "$scratch/elsewhere" "$scratch/prefix"
source=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$build/CMakeCache.txt")
if grep -rlF -e "$source" -e "$build" "$scratch/prefix" --include='*.cmake' --include='*.h'; then
  echo "package: the files above name the folder that hbar was built in" >&2
  exit 1
fi

# As it is, and with flags that would change the alignment of Eigen's types.
for flags in "" "-march=native"; do
  folder=$scratch/stranger$flags
  echo "package: a stranger's project with flags '$flags'"
  cmake -G Ninja -S "$here" -B "$folder" -DCMAKE_PREFIX_PATH="$scratch/prefix" \
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" -DCMAKE_CXX_FLAGS="$flags"
  cmake --build "$folder"
  "$folder/stranger"
  "$folder/alone"
done

# Both sides of the interface allocate alike, whatever compiler and machine each is for.
machines=none
[ "$(uname -m)" != x86_64 ] || machines="none native"
! grep -qw avx2 /proc/cpuinfo 2>/dev/null || machines="$machines x86-64-v3"
for compiler in g++ clang++; do
  if ! command -v $compiler >/dev/null; then
    echo "package: skipped: memory shared with a program by $compiler, which is not installed"
    continue
  fi
  echo 'int main() {}' >"$scratch/empty.cpp"
  sanitize=-fsanitize=address
  if ! $compiler $sanitize "$scratch/empty.cpp" -o "$scratch/empty" 2>/dev/null; then
    echo "package: $compiler has no address sanitizer here: without it"
    sanitize=
  fi
  for machine in $machines; do
    flags=$sanitize
    [ "$machine" = none ] || flags="$sanitize -march=$machine"
    folder=$scratch/allocation-$compiler-$machine
    cmake -G Ninja -S "$here" -B "$folder" -DCMAKE_PREFIX_PATH="$scratch/prefix" \
      -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_CXX_FLAGS_RELEASE="-O1" -DCMAKE_CXX_FLAGS="$flags" >"$folder.log"
    cmake --build "$folder" --target allocation >>"$folder.log"
    echo "package: $compiler, -march: $machine"
    "$folder/allocation"
  done
done

# A component that does not exist, and one that was not built, are refused by name.
mkdir "$scratch/refused"
cat >"$scratch/refused/CMakeLists.txt" <<'PROJECT'
cmake_minimum_required(VERSION 3.22)
project(refused LANGUAGES CXX)
find_package(hbar REQUIRED COMPONENTS ${COMPONENT})
PROJECT
refuses() {
  if cmake -G Ninja -S "$scratch/refused" -B "$scratch/refused/build" -DCOMPONENT="$1" \
       -DCMAKE_PREFIX_PATH="$scratch/prefix" >"$scratch/refused.log" 2>&1 ||
     ! tr '\n' ' ' <"$scratch/refused.log" | tr -s ' ' | grep -q "$2"; then
    echo "package: the component $1 was not refused with '$2'" >&2
    exit 1
  fi
}
refuses teleport 'no component teleport; its components are'
rm "$scratch"/prefix/lib*/cmake/hbar/hbar_nlopt* "$scratch"/prefix/lib*/*/cmake/hbar/hbar_nlopt* \
  2>/dev/null || true
refuses nlopt 'built without hbar::nlopt.*libnlopt-dev'

# Without CMake: as the error says, or refused with what to do.
compile="${CXX:-c++} -std=c++20 -fsyntax-only -I$scratch/prefix/include $(pkg-config --cflags eigen3)"
remedy="-DEIGEN_MAX_ALIGN_BYTES=64 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16 -DEIGEN_MALLOC_ALREADY_ALIGNED=0"
wider=
[ "$(uname -m)" != x86_64 ] || wider=-mavx2
$compile $wider $remedy "$here/main.cpp"
for flags in "" $wider; do
  if $compile $flags "$here/main.cpp" 2>"$scratch/refused.log"; then
    echo "package: a program that lays out its memory otherwise was not refused" >&2
    exit 1
  fi
  grep -q -e "error.*$remedy" "$scratch/refused.log"
done
echo "package: ok"
