# SPDX-License-Identifier: BSD-3-Clause
"""Modules that aquafarm_plan and aquafarm_report share."""
