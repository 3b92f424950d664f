"""The page features of simulated worlds, which are created on demand."""

from linkwright.page.protocol import modelling, simulation
from linkwright.panels.on_demand import OnDemand

ON_DEMAND = (
    OnDemand(
        "linkwright.simulation.page.modelling.feature:ModellingFeature",
        (
            modelling.AddEntity,
            modelling.AskModels,
            modelling.ChangeEntities,
            modelling.CopyEntities,
            modelling.DeleteEntities,
            modelling.GroupEntities,
            modelling.RedoWorld,
            modelling.SaveWorld,
            modelling.SetModelling,
            modelling.UndoWorld,
            modelling.UngroupEntity,
        ),
        ("/world_description",),
        until=modelling.NO_WORLD,
    ),
    OnDemand(
        "linkwright.simulation.page.controls:SimulationFeature",
        (
            simulation.ControlSimulation,
            simulation.SpawnModel,
            simulation.DeleteModel,
            simulation.DragModel,
            simulation.PushLink,
        ),
        ("/simulation_state",),
        until=simulation.NO_SIMULATION,
        refuses_recordings=True,
    ),
)
