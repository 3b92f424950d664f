"""The page features of navigation, created on demand."""

from linkwright.panels.page_feature import OnDemand, list_message_paths

ON_DEMAND = (
    OnDemand(
        "linkwright.navigation.page.goal_outcome:GoalOutcomeFeature", topics=("/navigate_to_pose/_action/status",)
    ),
    OnDemand(
        "linkwright.navigation.page.commands:NavigationFeature",
        list_message_paths("linkwright.page.protocol.navigation", "CommandNavigation", "WatchNavigation"),
    ),
)
