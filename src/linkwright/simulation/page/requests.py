"""The page features of simulated worlds, created on demand."""

from linkwright.page.protocol.simulation import NO_SIMULATION, NO_WORLD
from linkwright.panels.page_feature import OnDemand, list_message_paths

_PROTOCOL_MODULE = "linkwright.page.protocol.simulation"

ON_DEMAND = (
    OnDemand(
        "linkwright.simulation.page.modeling.feature:ModelingFeature",
        (
            *list_message_paths(
                _PROTOCOL_MODULE, "AddEntity", "ChangeEntities", "CopyEntities", "DeleteEntities", "RequestModels"
            ),
            *list_message_paths(
                _PROTOCOL_MODULE, "GroupEntities", "RedoWorld", "SaveWorld", "SetModeling", "UndoWorld", "UngroupEntity"
            ),
        ),
        ("/world_description",),
        until=NO_WORLD,
    ),
    OnDemand(
        "linkwright.simulation.page.controls:SimulationFeature",
        list_message_paths(_PROTOCOL_MODULE, "ControlSimulation", "SpawnModel", "DeleteModel", "DragModel", "PushLink"),
        ("/simulation_state",),
        until=NO_SIMULATION,
        refuses_recordings=True,
    ),
)
