# The commands of this repository. Each works alone on a fresh Debian 12 or Ubuntu 24.04 machine: what is missing is
# installed first (toolchain/setup.sh), and nothing is fetched when nothing is missing.

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help

PRESET := release
BUILD := build/$(PRESET)
JOBS ?= $(shell nproc)
RUNS ?= 1000000
SAMPLE ?= 20
PUBLISHED := 20 near seed=59
PYTHON := .venv/bin/python
DEMO := A10 A15 A16 A18a A18b A18c
DEMO_OUT := out/demo
PICTURED := A10 A11 A16 A18b
PICTURED_A := A10 A11 A15 A16
PICTURED_B := B09 B14 B15 B16 B20
LOW_PASS := toolchain/book/cases/paper_flux_low_pass.toml --set flux_cutoff=78 --set inverter.switch_threshold=0.7 --set inverter.diode_threshold=0.7
PICTURES_OUT := out/pictures

# A Python path set for something else must not reach into .venv; nor that no compiled module is kept, for then every start
# of a command compiles all of them anew: the tests start commands some thousand times.
unexport PYTHONPATH PYTHONHOME PYTHONDONTWRITEBYTECODE

.PHONY: help setup build test demo bench bench-c28x catalogue isr-cost image-check int16 vectors cppcheck prove mcdc mutants verify \
	loss fuzz fuzz16 wheel figures figures-long pictures docs lint format lock clean

help: ## list these targets
	@echo "stillspin: targets"
	@awk -F ':.*## ' '/^[a-z0-9-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' Makefile

setup: ## install what is missing: Debian packages, Python packages in .venv
	@bash toolchain/setup.sh

build: setup ## compile firmware, virtual chip, plant and Python module into build/release
	@mkdir -p build
	@cmake --preset $(PRESET) >build/configure.log 2>&1 || { cat build/configure.log; exit 1; }
	@cmake --build --preset $(PRESET) --parallel $(JOBS)

test: build ## run every check, the C++ tests and the Python tests
	@bash toolchain/setup.sh build test llvm
	@bash toolchain/run-tests.sh $(PRESET)

demo: build ## commission the drive, reproduce the main figures of the first paper, write out/demo/report.html
	@rm -rf $(DEMO_OUT)
	@status=0; .venv/bin/stillspin reproduce $(DEMO) --no-paper-scheme --no-nameplate --out $(DEMO_OUT) || status=$$?; \
	if [[ -f $(DEMO_OUT)/report.html ]]; then bash toolchain/show.sh $(DEMO_OUT)/report.html; fi; \
	exit $$status  # 1 when a run broke off or a goal is missed: the report says which and why

bench: build ## measure how fast the simulation runs
	@bash toolchain/setup.sh build bench
	@$(PYTHON) toolchain/keep.py speed bash toolchain/bench.sh $(BUILD)
	@$(PYTHON) toolchain/keep.py c28x tests/python/c28x_speed.py build/bench/c28x.json

bench-c28x: build ## the same of code of the C28x alone; fails below 30 million instructions a second with peripherals
	@$(PYTHON) tests/python/c28x_speed.py --least 30

catalogue: build ## ask the drive about every motor of the catalogue: what works, what is refused and why
	@mkdir -p build/catalogue
	@$(PYTHON) toolchain/keep.py catalogue .venv/bin/stillspin motor list --json build/catalogue/figures.json

isr-cost: build ## count the interrupts' instructions on a Cortex-M3 (QEMU): cycles of a period; bit for bit the native run
	@bash toolchain/setup.sh build cortex
	@$(PYTHON) toolchain/keep.py isr-cost toolchain/isr/count.py $(BUILD)/tests/m3 build/image-check build/isr-cost

image-check: setup ## estimate the DSP's image, by edition and of EDITION, by a stand-in for TI's compiler: symbols, sizes, stack
	@bash toolchain/setup.sh build cortex
	@$(PYTHON) toolchain/keep.py image toolchain/image/check.py build/image-check $(EDITION)

int16: build ## run every scenario compiled with a 16-bit int and char, bit for bit the native run, and planted defects
	@bash toolchain/setup.sh build llvm
	@$(PYTHON) -m pytest -q -c sim_host/pyproject.toml --rootdir . tests/python/test_int16.py
	@cmake --build --preset int16
	@$(PYTHON) toolchain/int16/compare_runs.py $(BUILD)/tests/int16/stillspin_int16

vectors: ## run the arithmetic's vectors on AVR, Cortex-M3 and M4 against a model in Python, and with planted defects
	@bash toolchain/setup.sh build avr cortex
	@$(PYTHON) toolchain/vectors.py build/vectors
	@$(PYTHON) toolchain/vectors.py build/vectors --defects

cppcheck: ## read the drive's C with the C28x's widths, and planted defects
	@bash toolchain/setup.sh build cppcheck
	@$(PYTHON) toolchain/cppcheck.py
	@$(PYTHON) toolchain/cppcheck.py --defects

prove: ## absence of run-time errors with a 16-bit int, by Frama-C, and planted defects
	@bash toolchain/setup.sh build prove
	@$(PYTHON) toolchain/keep.py prove toolchain/prove.py build/prove
	@$(PYTHON) toolchain/prove.py build/prove --defects

mcdc: ## cover the decisions of the drive's C by the C++ tests: lines, branches, MC/DC of every condition
	@bash toolchain/setup.sh build llvm
	@$(PYTHON) toolchain/keep.py mcdc toolchain/mcdc.py

mutants: setup ## change the drive's C in SAMPLE places (20, or all) of each part, and count what the C++ tests notice
	@$(PYTHON) toolchain/mutants.py $(SAMPLE)
	@if [[ "$(SAMPLE)" == "$(PUBLISHED)" ]]; then $(PYTHON) toolchain/keep.py mutants; fi

verify: image-check isr-cost cppcheck prove vectors int16 fuzz16 mcdc ## the checks that take long: these eight, and whether any published figure is of older sources
	@$(PYTHON) toolchain/figures.py --list

loss: build ## lose synchronism on purpose in some 400 runs and print how soon the drive notices
	@$(BUILD)/tests/bench/stillspin_loss_campaign

fuzz: setup ## search for octets and CAN frames that break the firmware, also with a 16-bit int, RUNS of each (1000000)
	@bash toolchain/setup.sh build llvm
	@bash toolchain/fuzz.sh $(RUNS)

fuzz16: setup ## a short search with a 16-bit int, the same every time, and planted defects that it has to find
	@bash toolchain/setup.sh build llvm
	@bash toolchain/fuzz.sh 10000 short

wheel: build ## build the client for people without a compiler, and this machine's virtual drive, into dist/
	@$(PYTHON) toolchain/wheel.py dist

figures: build ## run what the tables of README and book have their figures from; goes on where it was broken off
	@$(PYTHON) toolchain/figures.py

figures-long: build ## the same and what takes longer: every estimator over speed, all starts, a board in the loop
	@$(PYTHON) toolchain/figures.py --long

pictures: build ## renew the pictures of README and book, docs/images
	@bash toolchain/setup.sh build test
	@rm -rf $(PICTURES_OUT)
	@.venv/bin/stillspin reproduce $(PICTURED) --no-paper-scheme --no-nameplate --out $(PICTURES_OUT)
	@$(PYTHON) toolchain/overview.py $(PICTURES_OUT) docs/images/bench.png
	@$(PYTHON) toolchain/tuning_pictures.py
	@for id in $(PICTURED_A); do \
	  .venv/bin/stillspin run $$id --scheme paper --profile ideal --set adc.noise=1.2 --no-plots --out $(PICTURES_OUT)/$$id || [ $$? = 1 ] || exit 2; done
	@for id in $(PICTURED_B); do \
	  .venv/bin/stillspin run $$id --scheme paper_flux --profile ideal --no-plots --out $(PICTURES_OUT)/$$id || [ $$? = 1 ] || exit 2; done
	@for id in B14 B15 B16; do \
	  .venv/bin/stillspin run $$id --scheme $(LOW_PASS) --profile ideal --no-plots --out $(PICTURES_OUT)/low-pass/$$id || [ $$? = 1 ] || exit 2; done
	@$(PYTHON) toolchain/papers_pictures.py $(PICTURES_OUT) docs/images
	@STILLSPIN_PICTURES=docs/images $(PYTHON) -m pytest -q -c sim_host/pyproject.toml --rootdir . tests/python/test_tune_on_board.py tests/python/test_tune_wizard.py tests/python/test_notebook.py
	@$(PYTHON) toolchain/keep.py pictures

docs: setup ## build the book into site/
	@$(PYTHON) -m mkdocs build --quiet --strict --config-file toolchain/mkdocs.yml
	@bash toolchain/show.sh site/index.html

lint: setup ## run the checks alone: include arrows, 16-bit int, formatting, types, links
	@$(PYTHON) toolchain/check.py

format: setup ## rewrite C, C++ and Python in the house format
	@$(PYTHON) toolchain/check.py --fix format ruff

lock: setup ## renew toolchain/requirements.lock (needs the network)
	@bash toolchain/lock.sh

clean: ## remove build products and reports; .venv stays
	@rm -rf build dist out site sim_host/stillspin/_core*.so .mypy_cache .ruff_cache .pytest_cache
	@find . -name __pycache__ -not -path './.venv/*' -prune -exec rm -rf {} +
