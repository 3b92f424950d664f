import type { Strings } from "../en";

/** TurtleSim 面板 */
export const turtlesim: Strings["turtlesim"] = {
  panel: "小乌龟 TurtleSim",
  none: "没有正在运行的 turtlesim_node。",
  driveHint: (topic) => `打开遥控面板，驱动 ${topic}`,
};
