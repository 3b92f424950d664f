"""The manifest of the packages in tests of rules."""

MANIFEST = """<package format="3"><name>p</name><version>1.0.0</version><description>A robot.</description>
<maintainer email="a@b.org">A</maintainer><license>MIT</license>{more}</package>"""
