# Needs make and Python 3.11 or newer. Another Python: make PYTHON=python3.13 demo (after make clean).
PYTHON ?= python3
# Arguments: make test ARGS="-k friction", make benchmark ARGS=--quick
ARGS ?=

BIN := .venv/bin
# Python compiles what it imports; to compile all of each package takes pip twice as long. In this
# variable `no` means --no-compile, and it reaches the installations of the build, too.
INSTALL := PIP_NO_COMPILE=no $(BIN)/python -m pip install --quiet --disable-pip-version-check

.PHONY: help demo test check benchmark fuzz format clean package dependencies
.DEFAULT_GOAL := help
# a .venv that could not be finished is made anew the next time
.DELETE_ON_ERROR:

help:            ## this list
	@sed -n 's/^\([a-z]*\):.*## /make \1\t/p' Makefile

demo: .venv/installed            ## run the demonstration
	$(BIN)/tracewire demo

test: .venv/installed-test            ## run the tests
	$(BIN)/python -m pytest --numprocesses auto --dist worksteal $(ARGS)

check: .venv/installed-test            ## style and types
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy

benchmark: .venv/installed-benchmark            ## time it beside other solvers: make benchmark ARGS=--quick
	$(BIN)/python -m benchmarks $(ARGS)

fuzz: .venv/installed-test            ## random systems beside exact solutions: make fuzz ARGS="--count 10000"
	PYTHONPATH=tests $(BIN)/python -m fuzz $(ARGS)

format: .venv/installed-test            ## repair style where it can be done by rule
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

clean:            ## remove .venv, caches and build products
	rm -rf .venv dist build solver/tracewire/solve/core_library .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find solver blocks tests -name __pycache__ -prune -exec rm -rf {} +

# A stamp is as old as the last installation; a newer pyproject.toml installs again.
.venv/installed: pyproject.toml | $(BIN)/python
	@echo "Installing tracewire into .venv, once ..."
	@$(MAKE) --silent --jobs=2 package dependencies
	@touch $@

# The package makes the machine code of its core, which takes longest; its dependencies come meanwhile.
package:
	@$(INSTALL) --no-deps -e .

dependencies:
	@$(BIN)/python -c 'import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["dependencies"], sep="\n")' | $(INSTALL) -r /dev/stdin

.venv/installed-test: pyproject.toml | $(BIN)/python
	@echo "Installing tracewire and its checks into .venv, once ..."
	@$(INSTALL) -e '.[test]'
	@touch $@

.venv/installed-benchmark: pyproject.toml | $(BIN)/python
	@echo "Installing tracewire and what it is timed against into .venv, once ..."
	@$(INSTALL) -e '.[benchmark]'
	@touch $@

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.version_info >= (3, 11) or sys.exit("tracewire needs Python 3.11 or newer, and $(PYTHON) is %d.%d. Name another: make PYTHON=python3.12 demo" % sys.version_info[:2])'
	@$(PYTHON) -m venv --clear .venv
