import { Box3, Vector3 } from "three";
import type { RobotScene } from "../../protocol";

/** A part nearer to the plane than this share of the robot's size is on it. */
const STANDS = 0.01;

/**
 * The height of a robot's ground in the fixed frame, m: its lowest point where that is below z = 0, as with wheels below
 * the frame that they turn about. A robot whose base is on z = 0 stays there whatever reaches below it, as an arm
 * may that is mounted on a table.
 *
 * @param robot its base are the links that no joint moves.
 * @param boxes around what is seen of each link, by its name.
 */
export function groundOf(robot: Pick<RobotScene, "links" | "joints">, boxes: ReadonlyMap<string, Box3>): number {
  const whole = around(boxes, [...boxes.keys()]);
  if (whole.isEmpty()) return 0;
  const margin = STANDS * whole.getSize(new Vector3()).length();
  const base = around(boxes, baseOf(robot));
  const stands = !base.isEmpty() && Math.abs(base.min.z) <= margin;
  return stands || whole.min.z >= -margin ? 0 : whole.min.z;
}

function around(boxes: ReadonlyMap<string, Box3>, links: Iterable<string>): Box3 {
  const box = new Box3();
  for (const link of links) {
    const each = boxes.get(link);
    if (each) box.union(each);
  }
  return box;
}

/** The links that are fixed to the root. */
function baseOf({ links, joints }: Pick<RobotScene, "links" | "joints">): Set<string> {
  const base = new Set(links.filter((link) => link.parent_joint === null).map((link) => link.name));
  const fixed = joints.filter((joint) => joint.kind === "fixed");
  for (let grown = true; grown; ) {
    const more = fixed.filter((joint) => base.has(joint.parent) && !base.has(joint.child));
    for (const joint of more) base.add(joint.child);
    grown = more.length > 0;
  }
  return base;
}
