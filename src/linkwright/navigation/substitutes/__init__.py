"""Our substitutes for packages of navigation that launch files include, as a prefix with their share folders."""
