# SPDX-License-Identifier: BSD-3-Clause
"""The campaigns of tools/campaign: one module each, with a function run(campaign)."""
