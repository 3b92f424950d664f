/** Explanations of the read-only rows of frames, links and joints, by RViz's names of the rows. */
export const details = {
  Parent: "The parent frame.",
  Position: "The position in the Fixed Frame, in meters.",
  Orientation: "The orientation in the Fixed Frame, as a quaternion x, y, z, w.",
  "Relative Position": "The position in the parent frame, in meters.",
  "Relative Orientation": "The orientation in the parent frame, as a quaternion x, y, z, w.",
  Type: "The type of the joint.",
  "Lower Limit": "The lower limit of the joint, in radians or meters.",
  "Upper Limit": "The upper limit of the joint, in radians or meters.",
  "Joint Axis": "The axis of motion, in the frame of the joint.",
  Effort: "The last effort of the joint, in newton meters or newtons.",
  "Max Effort": "The effort limit in the description, in newton meters or newtons.",
  Details: "The details of the frame.",
};

export type DetailName = keyof typeof details;
