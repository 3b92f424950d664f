"""Compare the code of launch files with the new names of renamed packages."""

from __future__ import annotations

from dataclasses import replace

from linkwright.review.launches.outlines import LaunchOutline
from linkwright.review.renames.packages import PackageNames, find_renamed_packages
from linkwright.review.versions import Versions


def rename_packages_in_code(versions: Versions, old: LaunchOutline, new: LaunchOutline) -> LaunchOutline:
    """Return an old launch file, with the new names of packages in statements that the new one has with them."""
    names = PackageNames(find_renamed_packages(versions))
    new_texts = {part.text for part in new.code}
    renamed = [replace(part, text=names.rename_derived(part.text)) for part in old.code]
    parts = [part if part.text in new_texts else own for part, own in zip(renamed, old.code, strict=True)]
    return replace(old, code=parts)
