# make run                      the demo: simulate an office, make its plan
# make run DATASET=PATH         the plan of a folder with recordings
# make run DATASET=PATH CONFIG=FILE   with settings from a file
# make run DATASET=PATH REPLACE=NAME  in the place of results/NAME, made of another source
# make test                     lint and all tests
# make bench                    the stages against the literal algorithms
# make settings                 write the lists in config/ and the manual's tables from the schema

CORES ?= 2
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
LIBRARIES := libusb-1.0-0 libgl1 libgomp1 libx11-6
SNAKEMAKE = PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/snakemake --cores $(CORES)

# a misspelt variable would make the demo instead of what was meant
KNOWN := CORES PYTHON DATASET CONFIG REPLACE ARGS
GIVEN := $(foreach name,$(.VARIABLES),$(if $(findstring command line,$(origin $(name))),$(name)))
UNKNOWN := $(filter-out $(KNOWN),$(GIVEN))
$(if $(UNKNOWN),$(error $(UNKNOWN): no such variable; there are $(KNOWN)))

.PHONY: run test lint bench settings environment clean
.DEFAULT_GOAL := run

run: environment
	@test -z "$(CONFIG)" || PYTHONPATH=scripts $(BIN)/python -m scanplan.project.settings "$(CONFIG)"
	@$(SNAKEMAKE) $(if $(CONFIG),--configfile "$(CONFIG)") \
	    $(if $(DATASET)$(REPLACE),--config $(if $(DATASET),'dataset="$(DATASET)"') $(if $(REPLACE),'replace="$(REPLACE)"')) \
	    $(ARGS)

test: environment lint
	@$(BIN)/pytest $(ARGS)

lint: environment
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .
	@$(BIN)/snakefmt --check Snakefile workflow/rules
	@PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/snakemake --lint

bench: environment
	@$(BIN)/python tests/benchmarks/run.py $(ARGS)

settings: environment
	@PYTHONPATH=scripts $(BIN)/python -m scanplan.project.settings_files

environment: $(VENV)/.ready

$(VENV)/.ready: environment.lock
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	    { echo "scanplan needs Python 3.11 or newer; name one with: make PYTHON=/path/to/python3.11"; exit 1; }
	@echo "setting up $(VENV) from environment.lock (about 1.4 GB, once)"
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

clean:
	rm -rf $(VENV) results logs benchmarks .snakemake
