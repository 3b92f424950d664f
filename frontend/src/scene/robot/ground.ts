import { Box3, Vector3 } from "three";
import type { RobotScene } from "../../protocol";

/** A part touches a plane if their distance is less than this fraction of the robot's size. */
const STANDING_TOLERANCE = 0.01;

/**
 * Returns the height of a robot's ground in the fixed frame, m: its lowest point if that is below z = 0, as for wheels
 * below the frame about which they turn. For a robot whose base touches z = 0, that is the ground, even if other parts
 * reach below it, as an arm mounted on a table may.
 *
 * @param robot - its base consists of the links that no joint moves.
 * @param boxes - the bounding boxes of the visible parts of each link, by its name.
 */
export function computeGroundHeight(robot: Pick<RobotScene, "links" | "joints">, boxes: ReadonlyMap<string, Box3>): number {
  const bounds = uniteBoxes(boxes, [...boxes.keys()]);
  if (bounds.isEmpty()) return 0;
  const margin = STANDING_TOLERANCE * bounds.getSize(new Vector3()).length();
  const baseBox = uniteBoxes(boxes, listFixedLinks(robot));
  const standsOnGround = !baseBox.isEmpty() && Math.abs(baseBox.min.z) <= margin;
  return standsOnGround || bounds.min.z >= -margin ? 0 : bounds.min.z;
}

function uniteBoxes(boxes: ReadonlyMap<string, Box3>, links: Iterable<string>): Box3 {
  const box = new Box3();
  for (const link of links) {
    const linkBox = boxes.get(link);
    if (linkBox) box.union(linkBox);
  }
  return box;
}

/** Returns the links that are fixed to the root. */
function listFixedLinks({ links, joints }: Pick<RobotScene, "links" | "joints">): Set<string> {
  const base = new Set(links.filter((link) => link.parent_joint === null).map((link) => link.name));
  const fixedJoints = joints.filter((joint) => joint.kind === "fixed");
  for (let hasGrown = true; hasGrown; ) {
    const newJoints = fixedJoints.filter((joint) => base.has(joint.parent) && !base.has(joint.child));
    for (const joint of newJoints) base.add(joint.child);
    hasGrown = newJoints.length > 0;
  }
  return base;
}
