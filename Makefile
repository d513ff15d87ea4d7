# The two commands of the README, and what gets the denoiser. Everything else is CMake: see CMakePresets.json.

JOBS ?= $(shell scripts/jobs.sh)

.PHONY: demo test denoiser build-demo build-test clean

# Installs what is needed, builds the program, renders an example, and says where the picture is.
demo:
	scripts/install-dependencies.sh build
	cmake --preset demo
	cmake --build --preset demo -j $(JOBS)
	scripts/demo.sh

# Installs what the tests need, builds, and runs every check.
test:
	scripts/install-dependencies.sh test
	scripts/test.sh $(JOBS)

# Gets Open Image Denoise, which Lumirank finds at run time; nothing needs to be built anew.
denoiser:
	scripts/get-denoiser.sh

clean:
	rm -rf build
