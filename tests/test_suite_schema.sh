#!/bin/sh
# test_suite_schema.sh - manifest, descriptors, answers and reports of the conformance suite against conformance/schema (conformance/tests/schemas.py). Speaks as
# cmocka programs do; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
if ! command -v python3 >/dev/null || [ ! -x "${TED4_BUILD:-}/ted4conf" ] || [ ! -x "$TED4_BUILD/ted4dec" ]; then
    echo "skipped: no python3, or TED4_BUILD has no ted4conf or no ted4dec"
    echo "[  SKIPPED ] suite_schema"
    exit 0
fi
PYTHONDONTWRITEBYTECODE=1 exec python3 conformance/tests/schemas.py
