# SPDX-License-Identifier: BSD-3-Clause
"""Writes the report of runs or a benchmark as one self-contained HTML file, readable on a phone."""
