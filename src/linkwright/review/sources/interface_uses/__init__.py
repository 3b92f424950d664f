"""Find the uses of interfaces and fields that the repository lost."""
