# `make` alone says what there is to make. Everything is installed into .venv, once; without OpenGL, no films are drawn.
.DEFAULT_GOAL := help
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PACKAGE := $(VENV)/.package
TOOLS := $(VENV)/.tools
LINTERS := $(VENV)/.linters
SITE := $(VENV)/.site
# There is a process for each core: threads of linear algebra would only take time from the others.
# A process that has nothing left to do takes tests from another.
PYTEST := OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n auto --dist worksteal
# What is not compiled when it is installed is compiled when it is first used, and kept: less disk, and sooner done.
export PYTHONDONTWRITEBYTECODE :=
PIP := $(BIN)/python -m pip --disable-pip-version-check install --quiet --no-compile

.PHONY: help report test quick everything search benchmark portability renders templates tables engines site dist lint clean

help:
	@echo "make report       checks everything, draws the films, and writes one page: report/index.html (minutes)"
	@echo "make test         installs the tools of the tests as well, then runs the tests (minutes)"
	@echo "make quick        runs the tests that take no time"
	@echo "make everything   runs the costly tests: real films, a notebook, a cluster (minutes)"
	@echo "make lint         runs ruff, the type checker, and import-linter, which is for those who change something"
	@echo "make search       makes 2,000 random runs, of which none may be wrong without saying so"
	@echo "make benchmark    measures run times anew, and writes study, picture and tables (ten minutes, undisturbed)"
	@echo "make engines      rolls a can in other physics engines (half an hour, 1 GB); ONLY=pymunk is for one of them"
	@echo "make renders      draws the animated pictures of the README anew"
	@echo "make templates    writes the files of mjcf/ that a viewer opens, and the digests of its mechanics"
	@echo "make tables       writes the tables of the documents anew"
	@echo "make site         writes all documents, the report and a reference as a site: build/site/index.html"
	@echo "make dist         builds the packages to publish, installs one elsewhere, and tries it"
	@echo "make portability  tries exported models in other tools (an hour, 1.5 GB)"
	@echo "make clean        removes what the others wrote"

report: $(PACKAGE)
	$(BIN)/mjbeer report --output report

test: $(TOOLS)
	$(PYTEST) -m "not costly"

quick: $(TOOLS)
	$(PYTEST) -m "not costly and not slow"

everything: $(TOOLS)
	$(PYTEST) -m costly

# -s shows the table.
search: $(TOOLS)
	MJBEER_EXAMPLES=2000 $(BIN)/python -m pytest -s tests/studies/stability/test_search.py -k wrong_and_silent

# Nothing else should run meanwhile.
benchmark: $(TOOLS)
	$(BIN)/mjbeer benchmark --output benchmark
	cp benchmark/study.json src/mjbeer/studies/benchmark/study.json
	cp benchmark/work_precision.svg renders/work_precision.svg
	$(BIN)/python tools/documents.py

# The other tools go into build/, as docs/portability.md has it.
portability: $(TOOLS)
	$(BIN)/python -m tools.portability

# If it was interrupted, it goes on. Nothing else should run meanwhile.
engines: $(TOOLS)
	$(BIN)/python -m tools.engines $(if $(ONLY),--only $(ONLY))
	$(BIN)/python tools/documents.py

renders: $(PACKAGE)
	$(BIN)/python docs/figures/renders.py renders
	$(BIN)/python docs/figures/carry.py
	$(BIN)/python docs/figures/grasp.py
	$(BIN)/python docs/figures/gauss_jackson.py

templates: $(PACKAGE)
	$(BIN)/python tools/templates.py mjcf

tables: $(TOOLS)
	$(BIN)/python tools/documents.py

# The report is made if there is none. The site is what any web host serves, and opens from the disk as well.
site: $(SITE) report/index.html
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict
	$(BIN)/python tools/site_links.py build/site

report/index.html:
	$(MAKE) report

# Nothing here needs .venv, which has mjbeer from the checkout: what is tried is the wheel, outside of the checkout.
dist:
	rm -rf dist build/release build/wheel
	$(PYTHON) -m venv build/release
	build/release/bin/python -m pip install --quiet --upgrade pip
	build/release/bin/python -m pip install --quiet --group release
	build/release/bin/check-jsonschema --builtin-schema vendor.citation-file-format CITATION.cff
	build/release/bin/python -m build
	build/release/bin/python -m twine check --strict dist/*
	$(PYTHON) -m venv build/wheel
	build/wheel/bin/python -m pip install --quiet dist/*.whl
	cd build && wheel/bin/mjbeer simulate frozen --phi0 180 --duration 0.8 --tolerance 1e-10
	cd build && wheel/bin/mjbeer export frozen --can metal --rolling contact --output can.xml
	cd build && wheel/bin/mjbeer validate

# The type checker reads what the tests import, too.
lint: $(LINTERS)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/ty check src tests tools
	$(BIN)/lint-imports

$(PACKAGE): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "mjbeer needs Python 3.11 or later, this is " + sys.version)'
	@echo "Installing mjbeer and what it needs into $(VENV), about 0.8 GB: this takes a minute or two."
	@$(PYTHON) -m venv --clear $(VENV)
	@$(PIP) --editable .
	@echo "Compiling the integrators for this machine."
	@$(BIN)/python -c 'from mjbeer import *; run = [simulate(frozen(), 1, 1, tolerance=each) for each in (1e-4, 1e-9)]'
	@touch $@

$(TOOLS): $(PACKAGE)
	@echo "Installing the tools of the tests into $(VENV), about 0.6 GB: this takes a minute or two."
	@$(PIP) --upgrade pip
	@$(PIP) --group test
	@touch $@

$(LINTERS): $(TOOLS)
	@$(PIP) --group dev
	@touch $@

$(SITE): $(PACKAGE)
	@$(PIP) --upgrade pip
	@$(PIP) --group site
	@touch $@

clean:
	rm -rf $(VENV) build report benchmark stability paper dist
