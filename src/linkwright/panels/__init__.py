"""The page features of a viewer, each in a module or package.

They handle most requests of pages.
"""
