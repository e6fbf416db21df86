# make help says what there is; CONTRIBUTING.md what to run before a commit

CORES ?= 2
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
LIBRARIES := libusb-1.0-0 libgl1 libgomp1 libx11-6
# Python reads scripts/startup first: Ctrl-C ends in one line while Snakemake itself is still read
SNAKEMAKE = PATH="$(CURDIR)/$(BIN):$$PATH" PYTHONPATH="$(CURDIR)/scripts/startup$${PYTHONPATH:+:$$PYTHONPATH}" \
    $(BIN)/snakemake $(if $(VERBOSE),--quiet host) --cores $(CORES)
# tests of one file stay together: they share a run of the workflow; their order is tests/conftest.py's
PYTEST = $(BIN)/pytest --numprocesses $(CORES) --dist loadfile --no-loadscope-reorder

# a misspelt variable would make the demo instead of what was meant
KNOWN := CORES PYTHON DATASET CONFIG REPLACE VERBOSE ARGS
GIVEN := $(foreach name,$(.VARIABLES),$(if $(findstring command line,$(origin $(name))),$(name)))
UNKNOWN := $(filter-out $(KNOWN),$(GIVEN))
$(if $(UNKNOWN),$(error $(UNKNOWN): no such variable; there are $(KNOWN)))

# of an option that is given twice Snakemake takes the last
TWICE := $(if $(DATASET)$(REPLACE),$(filter --config --config=% -C,$(ARGS))) $(if $(CONFIG),$(filter --configfile%,$(ARGS)))
$(if $(strip $(TWICE)),$(error ARGS: $(strip $(TWICE)) would take the place of DATASET, REPLACE or CONFIG; put settings into a file: CONFIG=FILE))

# every stage is a process, which would compile the package anew
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help run compare edit quick test tests test-slurm lint style types faults audit bench figures mutants pictures settings
.PHONY: environment kiss-icp clean
.DEFAULT_GOAL := run

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## /{printf "make %-12s %s\n", $$1, $$2}' $(firstword $(MAKEFILE_LIST))
	@echo
	@echo "make run DATASET=PATH                the plan of a folder with recordings"
	@echo "make run DATASET=PATH CONFIG=FILE    with settings from a file"
	@echo "make run DATASET=PATH REPLACE=NAME   in the place of results/NAME, made of another source"
	@echo "make run VERBOSE=1                   with all that Snakemake and the stages say"
	@echo "CORES=N for run, compare, quick and test (2); PYTHON=PATH for the set-up; ARGS='...' is handed on"

run: environment ## the demo: simulate an office, make its plan
	@$(SNAKEMAKE) $(TARGET) $(if $(CONFIG),--configfile "$(CONFIG)") \
	    $(if $(DATASET)$(REPLACE),--config $(if $(DATASET),'dataset=["$(DATASET)"]') $(if $(REPLACE),'replace=["$(REPLACE)"]')) \
	    $(ARGS)

compare: TARGET = comparison
compare: run ## the same with all orderings and extractors beside the plan's own

edit: environment ## the demo's report as an editor that carries out what is corrected; ARGS=results/X another one's
	@PYTHONPATH="$(CURDIR)/scripts/startup:$(CURDIR)/scripts$${PYTHONPATH:+:$$PYTHONPATH}" $(BIN)/python -P -c \
	    'import sys; from scanplan.project.run.command import main; sys.exit(main())' open --cores $(CORES) $(or $(ARGS),results/demo)

quick: environment style ## lint and the tests of what changed since main, under 90 seconds
	@changed=$$($(BIN)/python tests/changed_tests.py python); \
	    test -z "$$changed" || $(BIN)/basedpyright --project . $$changed
	@$(PYTEST) -m "not workflow and not recordings" $$($(BIN)/python tests/changed_tests.py tests) $(ARGS)

test: environment style ## lint and all tests but Slurm's, about 11 minutes
	@$(MAKE) --no-print-directory --jobs $(CORES) types tests

tests:
	@$(PYTEST) -m "not slurm" $(ARGS)

test-slurm: environment ## the profile for Slurm, on a Slurm installed and started here; as root on Debian
	@PYTHONPATH=tests $(BIN)/python -m helpers.slurm_node || exit 0; \
	    $(BIN)/pip install -qq --disable-pip-version-check --no-deps --require-hashes -r environment-slurm.lock && \
	    PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/pytest -n 0 -s -m slurm tests/slurm $(ARGS)

lint: environment style types ## style, types and the workflow's own checks

types: environment
	@$(BIN)/basedpyright --project .

style: environment
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .
	@$(BIN)/snakefmt --check Snakefile workflow/Snakefile workflow/rules workflow/thesis
	@PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/snakemake --lint
	@PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/snakemake --lint --snakefile workflow/thesis/Snakefile

faults: environment ## damaged and hostile input of every kind, and how each ends; an hour
	@PYTHONPATH=scripts:tests $(BIN)/python -m faults.run_faults $(ARGS)

audit: environment ## licences of all packages; fails on ones that do not fit the project's
	@$(BIN)/python tests/audit_licences.py

bench: environment ## the stages against the algorithms of the thesis written literally
	@$(BIN)/python tests/benchmarks/run.py $(ARGS)

figures: environment ## the house in figures; ARGS='OTHER_CHECKOUT .' compares, --places says where, --types counts errors
	@$(BIN)/python tests/house_figures.py $(ARGS)

mutants: environment ## the last commit's code changed at 60 places, and whether tests notice; ARGS="COUNT SEED --full"
	@$(BIN)/python tests/mutants.py $(ARGS)

pictures: environment ## the pictures of README.md from results/demo; ARGS='results/X X' the tour's
	@$(BIN)/python tests/pictures.py $(ARGS)

settings: environment ## write the lists in config/ and the manual's tables from the schemas
	@PYTHONPATH=scripts $(BIN)/python -m scanplan.project.settings_files
	@PYTHONPATH=scripts $(BIN)/python -m scanplan.store.column_lists

environment: $(VENV)/.ready ## set up .venv from environment.lock (run, test and the others do it)

$(VENV)/.ready: environment.lock
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	    { echo "scanplan needs Python 3.11 or newer; name one with: make PYTHON=/path/to/python3.11"; exit 1; }
	@test ! -L $(VENV) || { echo "$(VENV) is a link, and what it leads to would be emptied; remove the link: rm $(VENV)"; exit 1; }
	@echo "setting up $(VENV) from environment.lock (about 2 GB, once; some minutes in silence)"
	@"$(PYTHON)" -m venv --clear $(VENV) || \
	    { echo "this Python has no venv module; on Debian: apt-get install python3-venv"; exit 1; }
	@$(BIN)/pip install -qq --disable-pip-version-check --require-hashes -r environment.lock
	@$(BIN)/python -c 'import open3d' 2>/dev/null || { \
	    echo "installing the system libraries that Open3D needs: $(LIBRARIES)"; \
	    if [ "$$(id -u)" = 0 ]; then as_root=; else as_root="sudo -n"; fi; \
	    { $$as_root apt-get update -qq && $$as_root apt-get install -y -qq --no-install-recommends $(LIBRARIES); } \
	        >/dev/null 2>&1; \
	    $(BIN)/python -c 'import open3d' || \
	    { echo "Open3D lacks system libraries; install them with: apt-get install $(LIBRARIES)"; exit 1; }; }
	@touch $@

kiss-icp: environment ## add KISS-ICP, which estimates poses of recordings that have none (2 MB)
	@$(BIN)/pip install -qq --disable-pip-version-check --no-deps --require-hashes -r environment-kiss-icp.lock
	@echo "KISS-ICP is there: recordings of clouds without poses can be run"

clean: ## remove .venv and everything that was made
	rm -rf $(VENV) results logs benchmarks .snakemake
