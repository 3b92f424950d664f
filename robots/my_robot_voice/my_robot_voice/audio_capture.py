# SPDX-License-Identifier: Apache-2.0
"""The node that publishes a recording or a microphone, for ROS 2: it is Linkwright's, which pip installs and which speaks DDS."""

import sys

from linkwright.nodes.process import main as run


def main():
    """Run the node."""
    sys.exit(run('my_robot_voice', 'audio_capture', sys.argv[1:]))


if __name__ == '__main__':
    main()
