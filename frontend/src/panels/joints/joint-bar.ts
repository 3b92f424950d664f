import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { UnitSwitch } from "../../widgets/unit-switch";

/** Returns the controls of all joints: Randomize and Center as in joint_state_publisher_gui, and the unit of angles. */
export function createJointBar({ connection, angleUnits }: Session): HTMLElement {
  const texts = strings.joints;
  return h(
    "div",
    { class: "toolbar joint-tools" },
    createButton(texts.randomizeHint, () => connection.send({ type: "randomize_joints" }), "tool", createIcon("shuffle"), texts.randomize),
    createButton(texts.centerHint, () => connection.send({ type: "center_joints" }), "tool", createIcon("center"), texts.center),
    h("span", { class: "spacer" }),
    new UnitSwitch(angleUnits).element,
  );
}
