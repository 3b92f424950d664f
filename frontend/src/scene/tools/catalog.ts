import type { IconName } from "../../icons";
import { FocusCameraTool } from "./focus-camera";
import { InteractTool } from "./interact";
import { MeasureTool } from "./measure";
import { MoveCameraTool } from "./move-camera";
import { PoseTool } from "./pose";
import { PublishPointTool } from "./publish-point";
import { SelectTool } from "./select";
import type { SceneToolClass } from "./tool";

/** A class of tools; its settings are declared in `rviz/config/tools.py`. */
export interface ToolEntry {
  /** The key that RViz uses for the tool. */
  readonly key: string;
  readonly icon: IconName;
  readonly make: SceneToolClass;
}

/** The tools of RViz and nav2. */
export const TOOLS: ReadonlyMap<string, ToolEntry> = new Map<string, ToolEntry>([
  ["rviz_default_plugins/Interact", { key: "i", icon: "interact", make: InteractTool }],
  ["rviz_default_plugins/MoveCamera", { key: "m", icon: "move", make: MoveCameraTool }],
  ["rviz_default_plugins/Select", { key: "s", icon: "select", make: SelectTool }],
  ["rviz_default_plugins/FocusCamera", { key: "c", icon: "focus", make: FocusCameraTool }],
  ["rviz_default_plugins/Measure", { key: "n", icon: "measure", make: MeasureTool }],
  ["rviz_default_plugins/SetInitialPose", { key: "p", icon: "estimate", make: PoseTool }],
  ["rviz_default_plugins/SetGoal", { key: "g", icon: "goal", make: PoseTool }],
  ["nav2_rviz_plugins/GoalTool", { key: "g", icon: "goal", make: PoseTool }],
  ["rviz_default_plugins/PublishPoint", { key: "u", icon: "frame", make: PublishPointTool }],
]);
