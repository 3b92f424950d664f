from setuptools import find_packages, setup

package_name = 'my_voice'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages',
            ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='learner',
    maintainer_email='learner@example.org',
    description='Nodes that hear',
    license='MIT',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
            'word_driver = my_voice.word_driver:main',
            'level_meter = my_voice.level_meter:main',
            'goal_sender = my_voice.goal_sender:main',
        ],
    },
)
