# SPDX-License-Identifier: Apache-2.0
"""Installs the node, the launch file and the commands."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = 'my_robot_voice'
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
        (str(SHARE / 'config'), ['config/commands.yaml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    author='The Linkwright authors',
    author_email='maintainers@linkwright.dev',
    maintainer='The Linkwright authors',
    maintainer_email='maintainers@linkwright.dev',
    description='mbot does what it is told: commands by voice, in English and Chinese.',
    license='Apache-2.0',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
            'audio_capture = my_robot_voice.audio_capture:main',
            'voice_commander = my_robot_voice.voice_commander:main',
        ],
    },
)
