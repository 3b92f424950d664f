import { Box3, Group, type Mesh } from "three";
import { ContactShadow } from "./contact-shadow";
import type { Lighting } from "./light";
import { StudioLight } from "./studio-light";
import type { OwnLight } from "./surroundings";

/** The part of a robot's drawing that lighting needs. */
export interface LitRobot {
  light: Lighting;
  /** A key of the visible parts. */
  readonly visibleKey: string;
  readonly visibleMeshes: readonly Mesh[];
  /** Returns the height of the ground below the robot, in the fixed frame, m. */
  computeGround(): number;
  computeRoughBounds(): Box3;
}

/** The lighting of robots, and the shadows that they cast. */
export class RobotLight {
  readonly root = new Group();
  private readonly studio = new StudioLight();
  private readonly shadow = new ContactShadow();
  /** The key of the visible robots, and the height of the ground below them, m. */
  private ground = { robotsKey: "", height: 0 };

  constructor() {
    this.root.add(this.studio.root, this.shadow.root);
  }

  /**
   * Places light and shadows around robots.
   *
   * @param backdrop - the background color of a studio.
   * @returns the light in the scene, if any.
   */
  update(lighting: Lighting, robots: readonly LitRobot[], backdrop: string): OwnLight | null {
    this.studio.root.visible = lighting === "Studio";
    this.shadow.root.visible = lighting === "Soft";
    if (lighting === "Camera") return null;
    const key = robots.map((robot) => robot.visibleKey).join(";");
    if (key !== this.ground.robotsKey) this.ground = { robotsKey: key, height: Math.min(...robots.map((robot) => robot.computeGround())) };
    const { height } = this.ground;
    if (lighting === "Soft") {
      this.shadow.update(robots.flatMap((robot) => robot.visibleMeshes), height);
      return null;
    }
    this.studio.update(robots.reduce((sum, robot) => sum.union(robot.computeRoughBounds()), new Box3()), height);
    return { hasShadows: true, background: null, daylight: null, fog: null, backdrop };
  }
}
