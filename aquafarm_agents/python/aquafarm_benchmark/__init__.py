# SPDX-License-Identifier: BSD-3-Clause
"""The evaluation protocol of §4.2: trains, measures, compares and draws.

protocol  which learners, how long, and the paper's own numbers
runs      the trainings, in parallel, each resumable
measures  convergence, stability, EA, interquartile means and intervals
results   the table and files that a benchmark ends in
figures   Figs. 11 to 14 and the learning curves
"""
