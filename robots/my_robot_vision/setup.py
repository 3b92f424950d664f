# SPDX-License-Identifier: Apache-2.0
"""Installs the nodes, and into the share folder the launch files and what RViz shows."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = 'my_robot_vision'
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
        (str(SHARE / 'rviz'), ['rviz/vision.rviz']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    author='The Linkwright authors',
    author_email='maintainers@linkwright.dev',
    maintainer='The Linkwright authors',
    maintainer_email='maintainers@linkwright.dev',
    description='mbot sees: what is there, where it is, and how to get to it.',
    license='Apache-2.0',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
            'follow_object = my_robot_vision.follow_object:main',
            'detector = my_robot_vision.linkwright_nodes:detector',
            'tracking_node = my_robot_vision.linkwright_nodes:tracking_node',
            'detect_3d_node = my_robot_vision.linkwright_nodes:detect_3d_node',
            'object_seeker = my_robot_vision.linkwright_nodes:object_seeker',
        ],
    },
)
