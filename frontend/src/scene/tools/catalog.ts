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
  readonly toolClass: SceneToolClass;
}

/** The tools of RViz and nav2. */
export const TOOLS: ReadonlyMap<string, ToolEntry> = new Map<string, ToolEntry>([
  ["rviz_default_plugins/Interact", { key: "i", icon: "interact", toolClass: InteractTool }],
  ["rviz_default_plugins/MoveCamera", { key: "m", icon: "move", toolClass: MoveCameraTool }],
  ["rviz_default_plugins/Select", { key: "s", icon: "select", toolClass: SelectTool }],
  ["rviz_default_plugins/FocusCamera", { key: "c", icon: "focus", toolClass: FocusCameraTool }],
  ["rviz_default_plugins/Measure", { key: "n", icon: "measure", toolClass: MeasureTool }],
  ["rviz_default_plugins/SetInitialPose", { key: "p", icon: "estimate", toolClass: PoseTool }],
  ["rviz_default_plugins/SetGoal", { key: "g", icon: "goal", toolClass: PoseTool }],
  ["nav2_rviz_plugins/GoalTool", { key: "g", icon: "goal", toolClass: PoseTool }],
  ["rviz_default_plugins/PublishPoint", { key: "u", icon: "frame", toolClass: PublishPointTool }],
]);
