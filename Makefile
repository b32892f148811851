# make report: validate, draw the scenes, and write one page, report/index.html.   make test: all checks.
# Both set themselves up in .venv; the second time that takes a second. Without OpenGL, neither draws films.
.DEFAULT_GOAL := help
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: help report test quick search portability renders lint clean

help:
	@sed -n '1,2p' $(MAKEFILE_LIST)

report: $(STAMP)
	$(BIN)/mjbeer report --output report

test: $(STAMP) lint
	$(BIN)/python -m pytest -n auto

# What takes no time, for the loop of an edit: half a minute.
quick: $(STAMP)
	$(BIN)/python -m pytest -n auto -m "not slow"

# Two thousand new random runs, of which none may be wrong and silent: a minute or two. -s shows the table.
search: $(STAMP)
	MJBEER_EXAMPLES=2000 $(BIN)/python -m pytest -s tests/studies/stability/test_search.py -k wrong_and_silent

# What other tools make of portable exports, as docs/portability.md has it: 3 GB in build/, and an hour.
portability: $(STAMP)
	$(BIN)/python -m tests.support.others

# The films that the documents show, as animated pictures: half a minute.
renders: $(STAMP)
	$(BIN)/python -m mjbeer.report.gallery renders

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/ty check src tests
	$(BIN)/lint-imports

$(STAMP): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "mjbeer needs Python 3.11 or later, this is " + sys.version)'
	$(PYTHON) -m venv --clear $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet --editable . --group dev
	@touch $@

clean:
	rm -rf $(VENV) build report benchmark stability paper dist
