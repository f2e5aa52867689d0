#!/usr/bin/env bash
# What only a GPU can show, in at most 9 minutes: builds, runs the tests that may differ there, measures, and writes
# FOLDER/report.md with pictures and the driver's facts. A step that fails or takes too long is reported, and the next one runs.
# The exit status is 1 when a step failed. Without a GPU it ends, unless --software asks for a run that the report calls so.
#
# usage: gpu_check.sh [--software] [--carried FOLDER | --installed PYTHON] [--output FOLDER] [--no-limit] [--steps "NAME..."]
#        gpu_check.sh --fill FOLDER [--torch]    on a machine with a network and the same release of Debian or Ubuntu
#
# --installed: nothing is built; the package that this Python has installed is checked, for example by the wheel.
# --no-limit: steps take as long as they need. --steps: these alone, by their names in the report.
# --carried: nothing is fetched; packages come from a folder that --fill has filled. --torch puts PyTorch with CUDA into it (3 GB).
set -uo pipefail
cd "$(dirname "$0")/.."
output=gpu-report carried='' installed='' fill='' torch='' software='' unlimited='' steps=''
while [ $# -gt 0 ]; do
  case $1 in
    --software) software=1; shift ;;
    --torch) torch=1; shift ;;
    --no-limit) unlimited=1; shift ;;
    --carried | --installed | --output | --fill | --steps)
      [ $# -gt 1 ] || { echo "gpu_check: $1 needs a value" >&2; exit 2; }
      declare "${1#--}=$2"; shift 2 ;;
    *) echo "gpu_check: unknown argument $1" >&2; exit 2 ;;
  esac
done
release() { (. /etc/os-release && echo "$ID $VERSION_ID"); }
packages() { scripts/setup.sh list; echo libegl-dev; echo python3-pip; }

# All that the packages depend on too: what a fresh machine has of it is not known here.
fill_folder() {
  set -e
  mkdir -p "$1/packages" "$1/wheels"
  command -v dpkg-scanpackages >/dev/null || { echo "gpu_check: dpkg-scanpackages is missing (Debian: dpkg-dev)" >&2; exit 1; }
  mapfile -t all < <(packages | xargs apt-cache depends --recurse --no-recommends --no-suggests --no-conflicts --no-breaks \
      --no-replaces --no-enhances | grep -E '^[a-z0-9]' | grep -v ':i386$' | sort -u)
  # Names of virtual packages have no file.
  mapfile -t real < <(printf '%s\n' "${all[@]}" | xargs apt-cache --no-all-versions show 2>/dev/null | sed -n 's/^Package: //p' | sort -u)
  echo "${#real[@]} packages"
  (cd "$1/packages" && apt-get download -qq "${real[@]}" && dpkg-scanpackages -m . >Packages 2>/dev/null)
  python3 -m pip download -q --disable-pip-version-check -d "$1/wheels" -r scripts/requirements.txt 'pytest>=9' ${torch:+torch}
  release >"$1/release"
  du -sh "$1"
}
if [ -n "$fill" ]; then
  (fill_folder "$fill")
  exit
fi

gpu=$(nvidia-smi --query-gpu=name,driver_version,memory.total --format=csv,noheader 2>/dev/null | head -1)
if [ -z "$gpu" ] && [ -z "$software" ]; then
  echo "gpu_check: nvidia-smi finds no GPU here; --software runs the same steps on the CPU" >&2
  exit 1
fi
mkdir -p "$output"
output=$(realpath "$output")
[ -z "$carried" ] || carried=$(realpath "$carried")
export EASYPBR_DEVICE=gl EASYPBR_CACHE_DIR=$output/cache
# Where there is no GPU the driver must still be the one that draws.
[ -n "$gpu" ] || export EASYPBR_NATIVE=0
python=${installed:-.venv/bin/python} program=build/easypbr limit_s=540 failed=0 rows=()
[ -z "$installed" ] || program="$python -m easypbr"

# step NAME SECONDS COMMAND: within its own limit and what is left of the nine minutes.
step() {
  local name=$1 left=$((limit_s - SECONDS - 5)) status=0 begin=$SECONDS verdict most
  [[ -z $steps || " $steps " == *" $name "* ]] || return 0
  most=$(($2 < left ? $2 : left))
  [ -z "$unlimited" ] || most=86400
  if [ "$most" -lt 3 ]; then
    rows+=("| $name | left out: the nine minutes were over | |"); failed=1
    return
  fi
  timeout -k 3 "$most" bash -c "$3" >"$output/$name.log" 2>&1 </dev/null || status=$?
  case $status in
    0) verdict=done ;;
    77) verdict="left out: $(tail -1 "$output/$name.log")" ;;
    124 | 137) verdict="**stopped after $most s**"; failed=1 ;;
    *) verdict="**failed ($status)**"; failed=1 ;;
  esac
  rows+=("| [$name]($name.log) | $verdict | $((SECONDS - begin)) |")
  echo "$name: $verdict, $((SECONDS - begin)) s"
}

install_packages='scripts/setup.sh'
if [ -n "$carried" ]; then
  read -r -d '' install_packages <<END
set -e
[ "$(release)" = "\$(cat '$carried/release')" ] || { echo "the folder was filled for \$(cat '$carried/release'), this is $(release)"; exit 1; }
work=\$(mktemp -d); echo "deb [trusted=yes] file:$carried/packages ./" >\$work/sources
mkdir -p \$work/lists/partial; as_root=; [ "\$(id -u)" = 0 ] || as_root=sudo
options="-o Dir::Etc::sourcelist=\$work/sources -o Dir::Etc::sourceparts=- -o Dir::State::lists=\$work/lists -o APT::Sandbox::User=root"
\$as_root apt-get \$options update -qq
\$as_root env DEBIAN_FRONTEND=noninteractive apt-get \$options install -y -qq --no-install-recommends $(packages | tr '\n' ' ')
[ -x $python ] || /usr/bin/python3 -m venv --system-site-packages .venv
wheels=\$(ls '$carried/wheels' | grep -qi '^torch-' && echo torch || true)
$python -m pip install -q --no-index --find-links '$carried/wheels' -r scripts/requirements.txt 'pytest>=9' \$wheels
cp scripts/requirements.txt .venv/requirements
END
fi
built() { [ -n "$installed" ] || step "$@"; }
step facts 20 'uname -srm; grep -m1 "model name" /proc/cpuinfo; nproc; free -g | head -2; nvidia-smi || echo "no NVIDIA GPU is seen here"'
built packages 120 "$install_packages"
built build 270 "export CMAKE_BUILD_PARALLEL_LEVEL=\${CMAKE_BUILD_PARALLEL_LEVEL:-\$(nproc)}; set -e
# Another compiler may have warnings of its own. A build that stands is taken as it is.
[ -e build/CMakeCache.txt ] || werror=-DEASYPBR_WERROR=OFF
cmake --preset release \${werror:-} -DPython_EXECUTABLE=\$PWD/$python >/dev/null
cmake --build build --target easypbr easypbr_program python_package bench_frames test_gl test_gpu
$python scripts/link_python.py build .venv"
step doctor 20 "$program doctor"
built tests_gl 40 "build/tests/test_gl --gtest_brief=1 --gtest_filter='-*ShaderStandard*'"
built tests_gpu 40 'build/tests/test_gpu --gtest_brief=1'
step golden 60 "$python scripts/gpu_steps.py golden '$output'"
step driver_messages 60 "EASYPBR_GL_DEBUG=1 $python tests/golden/driver_messages.py"
step cuda 40 "$python scripts/gpu_steps.py cuda '$output'"
step recording 40 "$python scripts/gpu_steps.py recording '$output' ${gpu:+1280}"
step frames 60 "$python scripts/gpu_steps.py frames '$output' ${gpu:+1920}"
step textures_1_gb 60 "$python scripts/gpu_steps.py textures '$output' ${gpu:+16384}"
step splats 60 "$python scripts/gpu_steps.py splats '$output' ${gpu:+6000}"
built bench 120 "$python scripts/gpu_steps.py bench '$output' ${gpu:+23}"
# What fails for want of a module says nothing of the GPU.
step tests_python 180 "$python scripts/gpu_steps.py tests_python '$output'"

{
  echo "# GPU check"
  echo
  if [ -n "$gpu" ]; then echo "Measured on: $gpu"; else echo "**No GPU was found: all of this was drawn by the CPU, through the driver named below, and says nothing of a GPU.**"; fi
  echo
  grep -hE '^(easypbr|renderer|OpenGL|version|vendor|platform|context) ' "$output/doctor.log" 2>/dev/null | sed 's/^/    /'
  grep -h 'model name' "$output/facts.log" 2>/dev/null | sed 's/^/    /'
  echo "    $(release), $(git rev-parse --short HEAD 2>/dev/null || echo 'no revision'), $SECONDS s in all"
  echo
  echo '| Step | Result | s |'
  echo '|---|---|---|'
  printf '%s\n' "${rows[@]}"
  for name in golden driver_messages cuda recording frames textures_1_gb splats bench tests_python; do
    [ -s "$output/$name.log" ] || continue
    printf '\n## %s\n\n' "$name"
    tail -40 "$output/$name.log" | sed 's/^/    /'
  done
  printf '\n## Pictures\n\n'
  for picture in "$output"/*.png; do [ -e "$picture" ] && echo "![$(basename "$picture" .png)]($(basename "$picture"))"; done
} >"$output/report.md"
echo "$output/report.md"
exit $failed
