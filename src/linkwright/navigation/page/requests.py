"""The page features of navigation, created on demand."""

from linkwright.panels.page_feature import OnDemand, messages

ON_DEMAND = (
    OnDemand(
        "linkwright.navigation.page.goal_outcome:GoalOutcomeFeature", topics=("/navigate_to_pose/_action/status",)
    ),
    OnDemand(
        "linkwright.navigation.page.commands:NavigationFeature",
        messages("linkwright.page.protocol.navigation", "CommandNavigation", "WatchNavigation"),
    ),
)
