"""The declaration of the course's page feature, which pages can create."""

from linkwright.panels.page_feature import OnDemand, messages

ON_DEMAND = (
    OnDemand(
        "linkwright.learning.page.feature:CourseFeature",
        messages(
            "linkwright.page.protocol.learning", "AnswerStep", "CheckStep", "OpenStep", "TakeHint", "TakeSolution"
        ),
    ),
)
