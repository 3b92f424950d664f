from setuptools import find_packages, setup

package_name = 'my_senses'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(),
    data_files=[
        ('share/ament_index/resource_index/packages',
            ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='learner',
    maintainer_email='learner@example.org',
    description='Nodes that see and hear for mbot',
    license='MIT',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
            'color_finder = my_senses.color_finder:main',
            'command_listener = my_senses.command_listener:main',
        ],
    },
)
