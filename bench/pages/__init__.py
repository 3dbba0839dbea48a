"""The pages of bench/ and their charts, written from tables of wanted runs and the rows that are
there. Start with __main__.py.
SPDX-License-Identifier: BSD-2-Clause"""
