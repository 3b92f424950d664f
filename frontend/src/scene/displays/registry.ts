import type { DrawingClass } from "./drawing";
import { GridDrawing } from "./grid";
import { RobotModelDrawing } from "./robot-model";
import { TfDrawing } from "./tf";

/** The display classes this page draws, by RViz's names. A new display is one line here and one class. */
export const DRAWINGS: ReadonlyMap<string, DrawingClass> = new Map<string, DrawingClass>([
  ["rviz_default_plugins/Grid", GridDrawing],
  ["rviz_default_plugins/RobotModel", RobotModelDrawing],
  ["rviz_default_plugins/TF", TfDrawing],
]);
