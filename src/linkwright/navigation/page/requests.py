"""The page features of navigation, which are created on demand."""

from linkwright.page.protocol import navigation
from linkwright.panels.on_demand import OnDemand

ON_DEMAND = (
    OnDemand(
        "linkwright.navigation.page.goal_outcome:GoalOutcomeFeature", topics=("/navigate_to_pose/_action/status",)
    ),
    OnDemand(
        "linkwright.navigation.page.commands:NavigationFeature",
        (navigation.CommandNavigation, navigation.WatchNavigation),
    ),
)
