/** What the read-only rows of frames, links and joints mean, by RViz's names of the rows. */
export const details = {
  Parent: "The frame that it is attached to.",
  Position: "Where it is in the Fixed Frame, in metres.",
  Orientation: "How it is turned in the Fixed Frame: x, y, z, w of a quaternion.",
  "Relative Position": "Where it is as seen from its parent, in metres.",
  "Relative Orientation": "How it is turned as seen from its parent: x, y, z, w of a quaternion.",
  Type: "How the joint moves.",
  "Lower Limit": "Least position of the joint, in radians or metres.",
  "Upper Limit": "Greatest position of the joint, in radians or metres.",
  "Joint Axis": "What the joint turns about or moves along, in its own frame.",
  Effort: "The last effort of the joint, in newton metres.",
  "Max Effort": "Greatest effort that the description allows the joint, in newton metres.",
  Details: "What is known of it.",
};

export type DetailName = keyof typeof details;
