# Debian packages, and the list of what they are made of; included by the Makefile.
# The packages of the last commit, in build/deb. MAINTAINER: "NAME <ADDRESS>" of who answers for
# them; without it they name nobody, at an address that cannot exist (RFC 2606). make gives the
# script what its command line sets, in the environment, where no quotes are needed.
deb:
	sh tools/make-deb.sh $B/deb

# SPDX 2.3: every file of the source tree, and what builds and tests it.
sbom:
	@mkdir -p $B
	python3 tools/sbom.py $B/ted4.spdx.json

DEPS_DEB = dpkg-dev debhelper lintian debootstrap mandoc shared-mime-info file bash-completion
deps-deb: deps
	@$(call INSTALL_DEBIAN,$(DEPS_DEB))

.PHONY: deb deps-deb sbom
