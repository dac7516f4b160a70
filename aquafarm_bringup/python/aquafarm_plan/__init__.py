# SPDX-License-Identifier: BSD-3-Clause
"""Makes the page and the GeoJSON of a rescue plan from the plan file that aquafarm_plan writes."""
