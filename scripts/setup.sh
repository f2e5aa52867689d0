#!/usr/bin/env bash
# Installs what the build needs and this machine lacks: Debian packages (as root or with sudo) and .venv. With `tests` also
# what only tests, documentation and examples need (PyTorch and Ray are large); `list` names the packages of the build.
# usage: setup.sh [tests|list]
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(
  g++ cmake ninja-build ccache pkg-config
  libeigen3-dev libfmt-dev libtbb-dev nlohmann-json3-dev libcli11-dev libxxhash-dev libfast-float-dev
  libepoxy-dev libegl1 libegl-mesa0 libopengl0 libgl1-mesa-dri
  libspng-dev libturbojpeg0-dev libwebp-dev libtinyexr-dev zlib1g-dev libzstd-dev libmeshoptimizer-dev libnanoflann-dev libassimp-dev libdraco-dev libyaml-cpp-dev
  libstb-dev fonts-dejavu-core libglfw3-dev libxcb1-dev libimgui-dev libboost-dev
  libavcodec-dev libavformat-dev libavutil-dev libswscale-dev
  libgtest-dev python3-dev python3-venv
  libembree-dev
)
requirements=(scripts/requirements.txt)
if [ "${1:-}" = list ]; then
  printf '%s\n' "${packages[@]}"
  exit
fi
if [ "${1:-}" = tests ]; then
  packages+=(clang-14 libclang-rt-14-dev clang-format clang-tidy ffmpeg xvfb openbox xdotool x11-xkb-utils wmctrl xclip python3-torch groff-base zsh fish chromium debootstrap nginx-light locales
    doxygen abigail-tools valgrind glslang-tools spirv-tools mesa-vulkan-drivers g++-aarch64-linux-gnu qemu-user)
  # The page is built again by a test; Node may come from elsewhere.
  command -v npm >/dev/null || packages+=(nodejs npm)
  requirements+=(scripts/requirements-test.txt)
fi
missing=()
for package in "${packages[@]}"; do
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  echo "installing Debian packages: ${missing[*]}"
  as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "setup: run as root or install sudo, then again" >&2; exit 1; }
    as_root=(sudo)
  fi
  # A server that falls silent is an error after a minute, not a wait without end.
  patience=(-o Acquire::http::Timeout=60 -o Acquire::https::Timeout=60 -o Acquire::Retries=3)
  "${as_root[@]}" apt-get "${patience[@]}" update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get "${patience[@]}" install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

# Debian's Python with its own packages in sight, so that its torch can be used; that torch needs numpy below 2.
for file in "${requirements[@]}"; do
  stamp=.venv/$(basename "$file" .txt)
  cmp -s "$file" "$stamp" && continue
  echo "installing the Python packages of $file into .venv"
  [ -x .venv/bin/python ] || /usr/bin/python3 -m venv --system-site-packages .venv
  .venv/bin/python -m pip install --quiet --disable-pip-version-check -r scripts/requirements.txt -r "$file"
  cp "$file" "$stamp"
done
