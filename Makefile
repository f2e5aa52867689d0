# The two commands: `make demo` and `make test`. Each installs what is missing.
PYTHON := .venv/bin/python
BUILD := build
export CMAKE_BUILD_PARALLEL_LEVEL ?= $(shell nproc)

.PHONY: demo test library build setup setup-tests bench bench-light bench-light-peers wheel test-wheel test-carried deb release-check check-long check-notebook sanitize sanitize-address sanitize-thread fuzz docs format lint clean

# Library, command line and Python module, without tests and benchmarks.
library: setup
	@echo "build, $$(date -u +%T)"
	cmake --preset release -DPython_EXECUTABLE=$(CURDIR)/$(PYTHON)
	cmake --build $(BUILD) --target easypbr easypbr_program python_package
	$(PYTHON) scripts/link_python.py $(BUILD) .venv

build: library
	cmake --build $(BUILD)

setup:
	@scripts/setup.sh

setup-tests: setup
	@scripts/setup.sh tests

demo: library
	$(BUILD)/easypbr demo -o demo.png

test: setup-tests build
	@scripts/oracle.sh
	python3 scripts/check_includes.py
	python3 scripts/check_unity_names.py
	scripts/lint.sh
	scripts/test.sh

bench: build
	scripts/bench.sh

# CPU seconds that light takes, beside Mitsuba 3. Needs EASYPBR_TEST_DATA.
bench-light: setup-tests library
	@scripts/oracle.sh
	.venv-oracle/bin/python bench/light.py

# FLIP of pictures of EasyPBR, VTK, F3D and Open3D from Mitsuba 3's. Needs EASYPBR_TEST_DATA.
bench-light-peers: setup-tests library
	@scripts/oracle.sh
	@scripts/peers.sh
	.venv-oracle/bin/python bench/light_peers.py

# Wheels in dist/, for Python 3.10, 3.11, and 3.12 and later.
wheel: setup
	scripts/wheel.sh

# The wheels of dist/ from outside: fresh environments, a system with Python and nothing else. Needs root.
test-wheel: setup-tests
	scripts/test_wheel.sh

# scripts/gpu_check.sh --carried in a fresh system without a network. Needs root.
test-carried:
	scripts/test_carried.sh

# Debian packages in dist/: easypbr, libeasypbr, libeasypbr-dev, python3-easypbr.
deb: library
	cmake --build $(BUILD) --target easypbr_shell_pages
	cd $(BUILD) && cpack -G DEB -B $(CURDIR)/$(BUILD)/packages
	mkdir -p dist && cp $(BUILD)/packages/*.deb dist/

# What a release needs; `make release-check PARTS="version licenses docs"` checks some of it (scripts/release_check.py).
release-check: setup-tests build
	$(PYTHON) scripts/release_check.py $(PARTS)

check-long: setup-tests build
	scripts/check_long.sh

# The widget in JupyterLab, in an environment of its own.
check-notebook: setup-tests library
	scripts/check_notebook.sh

# All C++ tests under AddressSanitizer and UBSan, and under ThreadSanitizer; each alone by sanitize-address, sanitize-thread.
sanitize: setup-tests
	scripts/sanitize.sh

sanitize-address sanitize-thread: sanitize-%: setup-tests
	scripts/sanitize.sh $*

# Coverage-guided fuzzing of all readers: `make fuzz TIME=3600` seconds.
TIME ?= 600
fuzz: setup-tests
	scripts/fuzz.sh $(TIME)

docs: setup-tests build
	scripts/docs.sh

format:
	clang-format -i $$(git ls-files 'include/**.h' 'src/**.h' 'src/**.cpp' 'tests/**.h' 'tests/**.cpp' 'examples/**.cpp')

lint: setup-tests
	@scripts/lint.sh

clean:
	rm -rf build build-* demo.png
