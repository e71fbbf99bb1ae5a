# Two commands: `make demo` shows a whole fit over HTTP, `make test` passes the tests that need no
# patience; `make test-rest` passes all others, `make test-shapes` checks the fitter's annotations.
# Everything is installed into .venv from requirements.lock; a second run installs nothing. What is
# imported of it is compiled then: to compile all takes a third of the time.

PYTHON ?= python3
VENV := .venv
PACKAGES := $(VENV)/.installed
STAMP := $(VENV)/.compiled
SINGLE_THREADED := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
# Tests of one file share services and fits, so whole files are dealt out; long ones come first.
SIDE_BY_SIDE := --numprocesses 2 --dist loadfile --no-loadscope-reorder

# A wheel that is read as data may be that of any Python and platform.
ANY_PYTHON := --only-binary=:all: --python-version 3.12 --platform manylinux_2_28_x86_64

PYTEST := $(SINGLE_THREADED) $(VENV)/bin/python -m pytest $(SIDE_BY_SIDE)
# Compiled tests and modules are kept: every process, and each of the services that tests start,
# would compile them anew.
unexport PYTHONDONTWRITEBYTECODE

VERSION = $(shell sed -n 's/^VERSION = "\(.*\)"$$/\1/p' service/version.py)

# What fitter announces of its arguments and results, checked at every call of its quick unit tests.
CHECKED := -p tests.annotations --jaxtyping-packages=fitter,tests.annotations.checked

.PHONY: demo setup test test-rest test-shapes test-others test-long lint serve train report openapi examples docs page client wheel image audit release lock clean

demo: $(STAMP)
	$(VENV)/bin/maquette demo

setup: $(STAMP)

test: $(STAMP)
	$(PYTEST) -m "not rest"

test-rest: $(STAMP)
	$(PYTEST) -m rest

test-shapes: $(STAMP)
	$(PYTEST) -m shapes $(CHECKED)

# All tests that `make test-shapes` does not run: so CI runs each once.
test-others: $(STAMP)
	$(PYTEST) -m "not shapes"

# What other runs do in part, at length: cases of the contract, damaged inputs, killed processes.
test-long: $(STAMP)
	CONTRACT_EXAMPLES=50 $(SINGLE_THREADED) $(VENV)/bin/python -m pytest tests/contract/test_schemathesis.py
	$(VENV)/bin/python -m tests.fuzz
	$(VENV)/bin/python -m tests.chaos

lint: $(PACKAGES)
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/pyright
	$(VENV)/bin/lint-imports

serve: $(STAMP)
	$(VENV)/bin/maquette serve

train: $(STAMP)
	$(VENV)/bin/python -m fitter.training build

report: $(STAMP)
	$(VENV)/bin/python -m fitter.training report

# What a service answers, as the examples of the OpenAPI document: recorded, never written.
examples: $(STAMP)
	$(VENV)/bin/python -m tests.contract.recording

openapi: $(STAMP)
	$(VENV)/bin/python -m tests.contract.document
	$(VENV)/bin/python -m tests.contract.request_table

# The documentation site, into service/docs_site, from where the service shows it. Its notebooks run;
# a warning or one that fails ends it. It is put there when it is complete.
docs: $(STAMP) $(VENV)/.documented
	rm -rf $(VENV)/docs_site
	$(SINGLE_THREADED) $(VENV)/bin/sphinx-build -q -W -b html -d $(VENV)/.doctrees service/docs $(VENV)/docs_site
	find $(VENV)/docs_site -name '.buildinfo' -delete
	rm -rf service/docs_site
	mv $(VENV)/docs_site service/docs_site

$(VENV)/.documented: $(PACKAGES) requirements-docs.txt
	$(VENV)/bin/python -m pip install -q --disable-pip-version-check -r requirements-docs.txt
	touch $@

# The page's sources are TypeScript: this needs Node.js and npm. Its bundle is committed.
page:
	cd service/page && npm ci && npm run check && npm test && npm run build

# The client for TypeScript, into dist/: typed by the contract, without dependencies.
client:
	mkdir -p dist
	cd api_schemas/typescript && npm ci && npm run build && npm pack --pack-destination ../../dist

# Into dist/, with the source distribution that builds to the same wheel.
wheel: $(STAMP)
	$(VENV)/bin/python -m hatchling build

# Known vulnerabilities of the locked packages, as PyPI lists them: what a release asks.
audit:
	test -x .venv-audit/bin/pip-audit \
		|| { $(PYTHON) -m venv .venv-audit && .venv-audit/bin/python -m pip install -q --disable-pip-version-check pip-audit==2.10.1; }
	.venv-audit/bin/pip-audit --requirement requirements.lock --disable-pip --require-hashes

# The image of a release. Its base is named with its digest in docker/images.env.
image:
	. docker/images.env && docker build -f docker/Dockerfile -t maquette:$(VERSION) \
		--build-arg BASE_IMAGE="$$BASE_IMAGE" --build-arg VERSION=$(VERSION) \
		--build-arg REVISION="$$(git rev-parse HEAD)" --build-arg CREATED="$$(date -u +%Y-%m-%dT%H:%M:%SZ)" .

# Everything of a release, into dist/, built and tested; .ci/release says what, and how to go on after
# a step that failed.
release: $(STAMP)
	.ci/release $(STEPS)

lock:
	$(VENV)/bin/pip install -q pip-tools
	$(VENV)/bin/pip-compile -q --generate-hashes --no-emit-index-url --no-emit-trusted-host --no-emit-find-links \
		--strip-extras --extra dev --extra s3 --extra detector --extra heic -o requirements.lock pyproject.toml
	$(VENV)/bin/pip-compile -q --no-emit-index-url --no-emit-trusted-host --no-emit-find-links \
		--strip-extras --extra docs -c requirements.lock -o requirements-docs.txt pyproject.toml

$(STAMP): $(PACKAGES)
	$(VENV)/bin/python -m service.compute.kernels
	touch $(STAMP)

$(PACKAGES): pyproject.toml service/version.py requirements.lock requirements-detector.txt
	$(PYTHON) .ci/system.py
	test -x $(VENV)/bin/python || $(PYTHON) -m venv $(VENV)
	$(VENV)/bin/python -m pip install -q --disable-pip-version-check --no-compile -r requirements.lock
	$(VENV)/bin/python -m pip install -q --disable-pip-version-check --no-deps -r requirements-training.txt
	$(VENV)/bin/python -m pip install -q --disable-pip-version-check --no-deps -e .
	$(VENV)/bin/python -m pip install -q --disable-pip-version-check --no-deps $(ANY_PYTHON) \
		--target "$$($(VENV)/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')" \
		-r requirements-detector.txt
	touch $(PACKAGES)

clean:
	rm -rf $(VENV) .venv-audit maquette-data demo-output dist service/docs_site
