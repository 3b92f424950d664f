"""Review a range of commits: changes to descriptions, worlds, launch files, parameters and interfaces."""

from linkwright.review.changes import Change, Effect, Figure, Review, Subject, SubjectKind
from linkwright.review.reviewing import review
from linkwright.review.versions import Versions, names_commit, open_versions

__all__ = [
    "Change",
    "Effect",
    "Figure",
    "Review",
    "Subject",
    "SubjectKind",
    "Versions",
    "names_commit",
    "open_versions",
    "review",
]
