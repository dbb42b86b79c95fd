# Two commands do all the set-up: `make demo` runs the main job, `make test` checks everything.
PYTHON ?= python3
BIN := .venv/bin

.PHONY: demo test wheel-test docs studies bench bench-sweeps kills format clean

demo: .venv/runtime
	$(BIN)/multilens experiment=demo

test: .venv/development
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/basedpyright
	$(BIN)/lint-imports
	$(BIN)/pytest -n auto --dist loadgroup

# The wheel in an empty environment, with all that it asks for: some minutes, and PyTorch again.
wheel-test: .venv/development
	$(BIN)/python -m hatchling build -d .venv/dist
	$(PYTHON) -m venv --clear .venv/wheel
	.venv/wheel/bin/python -m pip install --quiet --constraint constraints.txt "$$(ls -t .venv/dist/*.whl | head -1)[cad]"
	WHEEL_PYTHON=$(CURDIR)/.venv/wheel/bin/python $(BIN)/pytest tests/test_wheel.py

# The documentation as a site, in site/; `mkdocs serve` shows it while you write.
docs: .venv/development
	$(BIN)/mkdocs build --strict

# Three quarters of an hour: every study again, with its tables and figures.
studies: .venv/runtime
	for study in experiments/*/run.py; do $(BIN)/python $$study || exit 1; done

# The search against general optimisers: `make bench`, or `make bench QUICK=1` for a minute's worth.
bench: .venv/benchmark
	$(BIN)/python -m benchmark.run $(if $(QUICK),--quick)

# What a sweep costs beside its searches, and what a second worker brings: a quarter of an hour, on a machine that does nothing else.
bench-sweeps: .venv/runtime
	$(BIN)/python -m benchmark.sweeps

# A sweep of 24 jobs, killed at 20 random moments and run again each time: two minutes.
kills: .venv/runtime
	$(BIN)/python -m benchmark.kills

format: .venv/development
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

clean:
	rm -rf .venv runs sweeps site

.venv/runtime: pyproject.toml constraints.txt
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable .
	touch $@

.venv/development: .venv/runtime
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[dev,docs]'
	touch $@

.venv/benchmark: .venv/runtime
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[bench]'
	touch $@
