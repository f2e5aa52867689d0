# The two commands: `make demo` and `make test`. Each installs what is missing.
PYTHON := .venv/bin/python
BUILD := build
export CMAKE_BUILD_PARALLEL_LEVEL ?= $(shell nproc)

.PHONY: demo test build setup bench check-long docs format lint clean

build: setup
	cmake --preset release -DPython_EXECUTABLE=$(CURDIR)/$(PYTHON)
	cmake --build $(BUILD)
	$(PYTHON) scripts/link_python.py $(BUILD) .venv

setup:
	@scripts/setup.sh

demo: build
	$(BUILD)/easypbr demo -o demo.png

test: build
	@scripts/oracle.sh
	python3 scripts/check_includes.py
	scripts/test.sh

bench: build
	scripts/bench.sh

check-long: build
	scripts/check_long.sh

docs: build
	scripts/docs.sh

format:
	clang-format -i $$(git ls-files 'src/**.h' 'src/**.cpp' 'tests/**.h' 'tests/**.cpp' 'examples/**.cpp')

lint: build
	run-clang-tidy -quiet -p $(BUILD) "src/easypbr/(core|scene|io|gl|gpu|render|app|viewer|cli)/.*"

clean:
	rm -rf build build-* demo.png
