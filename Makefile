# Two commands for a fresh machine: `make paper` (the main job) and `make test`.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin

.PHONY: paper test lint docs clean

$(VENV)/installed-%: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet -e ".[$*]"
	touch $@

paper: $(VENV)/installed-paper ## reproduce the paper: figures and table under out/paper
	$(BIN)/carom paper --out out/paper

test: $(VENV)/installed-test ## all checks: style, types, tests, a part of them without the JIT
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/basedpyright
	$(BIN)/python -m pytest -n auto
	NUMBA_DISABLE_JIT=1 $(BIN)/python -m pytest -m plain

lint: $(VENV)/installed-test
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

docs: $(VENV)/installed-docs ## the pages; the examples of the gallery are run anew
	rm -rf docs/gallery
	$(BIN)/sphinx-build -W -b html docs out/docs

clean:
	rm -rf $(VENV) out docs/gallery
