import { FpsController } from "./fps";
import { OrbitController } from "./orbit";
import { TopDownOrthoController } from "./top-down-ortho";
import type { ViewController } from "./view-controller";
import { ThirdPersonFollowerController, XYOrbitController } from "./xy-orbit";

const ORBIT = new OrbitController();

/** RViz's view classes, whose properties are declared in `rviz/config/views.py`. */
const CONTROLLERS: ReadonlyMap<string, ViewController> = new Map<string, ViewController>([
  ["rviz_default_plugins/FPS", new FpsController()],
  ["rviz_default_plugins/Orbit", ORBIT],
  ["rviz_default_plugins/ThirdPersonFollower", new ThirdPersonFollowerController()],
  ["rviz_default_plugins/TopDownOrtho", new TopDownOrthoController()],
  ["rviz_default_plugins/XYOrbit", new XYOrbitController()],
]);

export function controllerOf(cls: string): ViewController {
  return CONTROLLERS.get(cls) ?? ORBIT;
}

/** Returns the name without the package: XYOrbit for `rviz_default_plugins/XYOrbit`. */
export function shortNameOf(cls: string): string {
  return cls.slice(Math.max(cls.lastIndexOf("/"), cls.lastIndexOf(":")) + 1);
}
