# To be sourced: python_of VERSION prints a Python of that version, from PATH or among pyenv's.
python_of() {
  local version=$1 candidate
  for candidate in "$(command -v "python$version" || true)" "${PYENV_ROOT:-$HOME/.pyenv}"/versions/"$version".*/bin/python; do
    # The shims of pyenv are there for versions that are not chosen, too.
    if [ -x "$candidate" ] && "$candidate" -c "import sys; sys.exit('%d.%d' % sys.version_info[:2] != '$version')" 2>/dev/null; then
      "$candidate" -c 'import sys; print(sys.executable)'
      return
    fi
  done
  echo "there is no Python $version in PATH or among pyenv's" >&2
  return 1
}
