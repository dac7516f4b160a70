# SPDX-License-Identifier: BSD-3-Clause
"""Page and GeoJSON of a rescue plan, from the plan file that aquafarm_plan writes."""
