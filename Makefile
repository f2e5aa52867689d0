# The two commands: `make demo` and `make test`. Each installs what is missing.
PYTHON := .venv/bin/python
BUILD := build
ROOMS := core|scene|io|gl|gpu|render|app|viewer|cli
export CMAKE_BUILD_PARALLEL_LEVEL ?= $(shell nproc)

.PHONY: demo test library build setup setup-tests bench check-long docs format lint clean

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
	scripts/test.sh

bench: build
	scripts/bench.sh

check-long: setup-tests build
	scripts/check_long.sh

docs: setup-tests build
	scripts/docs.sh

format:
	clang-format -i $$(git ls-files 'include/**.h' 'src/**.h' 'src/**.cpp' 'tests/**.h' 'tests/**.cpp' 'examples/**.cpp')

# Without precompiled headers, which clang-tidy cannot read; also shows includes that are missing.
lint: setup
	cmake -S . -B build-lint -G Ninja -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DEASYPBR_BUILD_PYTHON=OFF -DEASYPBR_BUILD_TESTS=OFF
	ninja -C build-lint generated/easypbr_shaders.inc generated/easypbr_dfg.inc
	run-clang-tidy -quiet -p build-lint "src/easypbr/($(ROOMS))/.*"

clean:
	rm -rf build build-* demo.png
