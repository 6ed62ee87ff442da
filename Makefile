# The README's two commands are `make demo` and `make test`. Each sets up .venv on a fresh machine by itself.
# The first Python that is new enough; a name may stand in PATH and yet not run.
NEW_ENOUGH := import sys; sys.exit(sys.version_info < (3, 11))
PYTHON ?= $(shell for name in python3 python3.11 python3.12 python3.13 python; do \
	$$name -c "$(NEW_ENOUGH)" 2>/dev/null && { echo $$name; break; }; done)
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
PIP := $(BIN)/python -m pip --quiet --disable-pip-version-check

.PHONY: help demo test test-slow test-checked test-all lint types imports wheel docs site lock clean

help:
	@echo "make demo     hide an effect in a simulated arm, diagnose it, open the envelope"
	@echo "make test     run the tests that are quick (PYTEST_ARGS='-k friction' for some of them)"
	@echo "make test-slow  run the slow ones; make test-all: both"
	@echo "make lint     ruff: rules and format"
	@echo "make types    pyright"
	@echo "make imports  the order of the rooms"
	@echo "make wheel    build dist/*.whl"
	@echo "make docs     write again what is generated: catalogue, confusion matrix, limits, figures from result files"
	@echo "make site     build the documentation site in ./site (open site/index.html; no server, no network)"
	@echo "make lock     write requirements.lock from .venv"

# requirements.lock pins what was tried together; the package itself is installed in place, for both targets alike.
$(STAMP): pyproject.toml requirements.lock
	@$(or $(PYTHON),false) -c "$(NEW_ENOUGH)" || \
		{ echo "no Python 3.11 or newer found: install one, or set PYTHON=/path/to/it" >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(PIP) install -r requirements.lock
	$(PIP) install --no-deps --no-build-isolation -e .
	@touch $@

demo: $(STAMP)
	$(BIN)/lagnet demo --out lagnet-demo

# One thread a worker: two workers share two cores, and linear algebra of this size gains nothing from more.
PYTEST := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n 2 --dist loadgroup
test: $(STAMP)
	$(PYTEST) -m "not slow" $(PYTEST_ARGS)

test-slow: $(STAMP)
	$(PYTEST) -m slow $(PYTEST_ARGS)

# Shapes, types and ranks held at run time, in the rooms whose annotations say them.
test-checked: $(STAMP)
	LAGNET_RUNTIME_CHECKS=1 $(PYTEST) tests/models $(PYTEST_ARGS)

test-all: $(STAMP)
	$(PYTEST) $(PYTEST_ARGS)

lint: $(STAMP)
	$(BIN)/ruff check src tests validation docs
	$(BIN)/ruff format --check src tests validation docs

types: $(STAMP)
	$(BIN)/pyright

imports: $(STAMP)
	$(BIN)/lint-imports

wheel: $(STAMP)
	rm -rf dist
	$(BIN)/python -m build --wheel --no-isolation --outdir dist

docs: $(STAMP)
	$(BIN)/python docs/make_catalogue.py
	$(BIN)/python docs/make_simulators.py
	$(BIN)/python docs/make_confusion.py
	$(BIN)/python docs/make_limits.py
	$(BIN)/python docs/fill_figures.py

# Strict: a link that leads nowhere or a reference to a name that does not exist fails the build.
site: $(STAMP)
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict --quiet
	@echo "site/index.html"

lock: $(STAMP)
	$(BIN)/python -m pip freeze --exclude-editable --exclude lagnet > requirements.lock

clean:
	rm -rf $(VENV) dist build site .pytest_cache .ruff_cache .import_linter_cache .hypothesis
