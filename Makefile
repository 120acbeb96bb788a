# Two commands for a fresh machine: `make paper` (the main job) and `make test`.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
# bytecode is kept: each of the many processes of the tests would compile all sources anew
export PYTHONDONTWRITEBYTECODE =
marked = $(shell grep -rlE --include='test_*.py' 'mark\.($(1))\b' tests)

.PHONY: paper test test-all verify lint docs bench history release-check wheel clean

$(VENV)/installed-%: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet -e ".[$*]"
	touch $@

paper: $(VENV)/installed-paper ## reproduce the paper: figures and table under out/paper
	$(BIN)/carom paper --out out/paper

# one process compiles everything before the tests: several would compile the same kernels. Beside it is done what
# needs no compiled code. A file of tests is run by one process, which keeps its scenes. Each day another tenth of
# the files is run with bodies that are nudged, and only so (tests/nudge.py)
TENTH := $(shell echo $$(( $$(date +%s) / 86400 % 10 )))
TESTS := $(BIN)/python -m pytest -n auto --dist loadfile
test: $(VENV)/installed-test ## style, types, tests but for the slow ones, today's tenth nudged, a part without the JIT
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/carom warmup --workers 1 & { $(BIN)/basedpyright && \
		NUMBA_DISABLE_JIT=1 $(BIN)/python -m pytest -m plain $(call marked,plain); }; beside=$$?; wait; exit $$beside
	CAROM_TEST_ALL_BUT=$(TENTH) $(TESTS) -m "not slow"
	CAROM_TEST_NUDGE=1 CAROM_TEST_TENTH=$(TENTH) $(TESTS) -m "not slow"

test-all: test ## the slow tests too, all nudged, and a part of all for another processor
	$(BIN)/python -m pytest -n auto -m slow $(call marked,slow|few)
	for units in 1 -1 3; do CAROM_TEST_NUDGE=$$units $(TESTS) -m "not slow" || exit 1; done
	NUMBA_CPU_NAME=generic NUMBA_CPU_FEATURES= $(TESTS) -m processors $(call marked,processors)

verify: $(VENV)/installed-test ## the tests of the verification manual, whose rows and page they write (docs/verification.md)
	$(TESTS) -m "verifies and not slow" --verified docs/_static/verification.json

lint: $(VENV)/installed-test
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: $(VENV)/installed-bench ## measure everything; tables and figures into the documentation
	$(BIN)/carom warmup
	$(BIN)/python benchmarks/all.py --docs

history: $(VENV)/installed-bench ## measure this commit for benchmarks/history (asv)
	cd benchmarks && ../$(BIN)/asv machine --yes && ../$(BIN)/asv run 'HEAD^!'

docs: $(VENV)/installed-docs ## the pages; the examples of the gallery are run anew
	rm -rf docs/gallery docs/_static/gallery docs/api/carom.*
	$(BIN)/sphinx-build -W -b html docs out/docs

release-check: $(VENV)/installed-test ## build wheel and sdist, look inside, install the wheel in an empty environment, run it
	$(BIN)/python -m pip install --quiet build
	$(BIN)/python tools/check_release.py

wheel: $(VENV)/installed-test ## a wheel for this platform with everything compiled; checks that its first run compiles nothing
	$(BIN)/python -m pip install --quiet build wheel
	$(BIN)/python tools/build_wheel.py

clean:
	rm -rf $(VENV) out docs/gallery docs/_static/gallery docs/api/carom.*
