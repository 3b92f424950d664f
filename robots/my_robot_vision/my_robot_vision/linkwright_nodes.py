# SPDX-License-Identifier: Apache-2.0
"""Linkwright's nodes as programs of this package, so that its launch files work under ROS 2, too.

There they are processes that speak DDS. Linkwright must be installed for the Python that runs them,
with the extras vision and dds.
"""

import sys

from linkwright.nodes.process import main


def run(executable):
    """Run one of Linkwright's nodes until Ctrl-C."""
    sys.exit(main('my_robot_vision', executable, sys.argv[1:]))


def detector():
    """Run what finds things in pictures."""
    run('detector')


def tracking_node():
    """Run what gives them ids."""
    run('tracking_node')


def detect_3d_node():
    """Run what says where they are."""
    run('detect_3d_node')


def object_seeker():
    """Run what goes to them."""
    run('object_seeker')
