"""Our substitutes for packages of Gazebo that launch files include, as a prefix with their share folders."""
