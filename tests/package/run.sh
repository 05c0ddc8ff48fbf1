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
done

# A component that was not built is refused by name.
mkdir "$scratch/refused"
cat >"$scratch/refused/CMakeLists.txt" <<'PROJECT'
cmake_minimum_required(VERSION 3.22)
project(refused LANGUAGES CXX)
find_package(hbar REQUIRED COMPONENTS teleport)
PROJECT
if cmake -G Ninja -S "$scratch/refused" -B "$scratch/refused/build" \
     -DCMAKE_PREFIX_PATH="$scratch/prefix" >"$scratch/refused.log" 2>&1 ||
   ! grep -q 'no component teleport' "$scratch/refused.log"; then
  echo "package: an unknown component was not refused" >&2
  exit 1
fi

# Without CMake: as the error says, or refused with what to do.
compile="${CXX:-c++} -std=c++20 -fsyntax-only -I$scratch/prefix/include $(pkg-config --cflags eigen3)"
remedy="-DEIGEN_MAX_ALIGN_BYTES=16 -DEIGEN_MALLOC_ALREADY_ALIGNED=0"
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
