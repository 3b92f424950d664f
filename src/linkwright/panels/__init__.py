"""The page features of a viewer, each in a module or package.

The features handle most requests of pages.
"""
