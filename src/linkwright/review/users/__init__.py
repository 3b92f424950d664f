"""The files of a repository that still use what a range of commits removed or renamed."""
