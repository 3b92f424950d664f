/** Texts of the TurtleSim panel. */
export const turtlesim = {
  panel: "TurtleSim",
  none: "No turtlesim_node is running.",
  driveHint: (topic: string): string => `Open Teleop for ${topic}`,
};
