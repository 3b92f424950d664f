# SPDX-License-Identifier: Apache-2.0
"""Installs the nodes, and into the share folder the launch files and the parameters."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = 'my_robot_control'
SHARE = Path('share') / PACKAGE

setup(
    name=PACKAGE,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        # The marker through which ROS 2 finds an installed package by its name.
        ('share/ament_index/resource_index/packages', ['resource/' + PACKAGE]),
        (str(SHARE), ['package.xml']),
        (str(SHARE / 'launch'), [str(path) for path in sorted(Path('launch').glob('*.launch.py'))]),
        (str(SHARE / 'config'), ['config/control.yaml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    author='The Linkwright authors',
    author_email='maintainers@linkwright.dev',
    maintainer='The Linkwright authors',
    maintainer_email='maintainers@linkwright.dev',
    description='Nodes that drive mbot, each small enough to be read in ten minutes.',
    license='Apache-2.0',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
            'drive_square = my_robot_control.drive_square:main',
            'follow_wall = my_robot_control.follow_wall:main',
            'go_to_pose = my_robot_control.go_to_pose:main',
            'follow_line = my_robot_control.follow_line:main',
            'avoid_obstacles = my_robot_control.avoid_obstacles:main',
        ],
    },
)
