# SPDX-License-Identifier: BSD-3-Clause
"""Tests that take more than 20 s on two cores; --fast leaves them out."""
SLOW = (
    # Tests through ROS, the longest first. tools/run_ros_tests starts them in this order.
    "benchmark", "doc_commands", "train_node", "train_launch", "agent_nodes", "policy_node", "report",
    "compare_browser", "script", "bag_policy", "replay", "started_launch", "launch_files",
    "record_replay", "plan_node", "rviz", "keep_episodes", "play_launch", "main_job", "plan_page",
    "gym_venv", "render_test",
    # Tests of the cores.
    "dqn_test", "multi_agent_test", "plan_program", "planner_test", "process_group_test", "ranks_test",
    "resume_test", "run_test")
