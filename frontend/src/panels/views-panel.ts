import { button, h } from "../dom";
import { icon } from "../icons";
import type { PropertyKind, PropertyValue } from "../protocol.gen";
import type { Session } from "../state/session";
import { FIXED_FRAME } from "../state/view";
import { strings } from "../strings";
import type { TreeItem } from "../tree/tree-item";
import { TreeView } from "../tree/tree-view";
import type { Panel } from "./panel";

/** RViz's Views panel for the current view. */
export class ViewsPanel implements Panel {
  readonly id = "views";
  readonly icon = "camera";
  readonly element: HTMLElement;

  constructor(private readonly session: Session) {
    const { view, frames } = session;
    const words = strings.views;
    const tree = new TreeView(
      strings.panels.views,
      () => this.items(),
      () => [FIXED_FRAME, ...frames.names],
    );
    const bar = h(
      "div",
      { class: "toolbar" },
      h("span", { class: "toolbar-label" }, words.orbit),
      h("span", { class: "spacer" }),
      button(words.zeroHint, () => view.zero(), "tool", icon("zero"), words.zero),
      button(words.resetHint, () => view.reset(), "tool", icon("reset"), words.reset),
    );
    this.element = h("div", { class: "panel" }, bar, tree.element);
    view.changed.on(tree.refresh);
  }

  private items(): TreeItem[] {
    const { view } = this.session;
    const current = view.current;
    const { names, help } = strings.views;
    const [x = 0, y = 0, z = 0] = current.focal_point;
    const row = (
      key: keyof typeof names,
      kind: PropertyKind,
      value: PropertyValue,
      set: (value: PropertyValue) => void,
      minimum: number | null = null,
    ): TreeItem => ({ key, name: names[key], kind, value, description: help[key], minimum, set });
    const coordinate = (name: string, index: number, value: number): TreeItem => ({
      key: `focalPoint/${name}`,
      name,
      kind: "float",
      value,
      description: help.focalPoint,
      set: (next) => {
        view.update({ focal_point: [x, y, z].map((old, i) => (i === index ? Number(next) : old)) });
      },
    });
    const number = (part: string) => (value: PropertyValue) => view.update({ [part]: Number(value) });
    return [
      row("distance", "float", current.distance, number("distance"), 0.01),
      row("yaw", "float", current.yaw, number("yaw")),
      row("pitch", "float", current.pitch, number("pitch")),
      {
        key: "focalPoint",
        name: names.focalPoint,
        kind: "group",
        value: [x, y, z].map((each) => String(Number(each.toPrecision(4)))).join("; "),
        description: help.focalPoint,
        expanded: true,
        children: () => [coordinate("X", 0, x), coordinate("Y", 1, y), coordinate("Z", 2, z)],
      },
      row("targetFrame", "frame", current.target_frame, (value) => view.setTargetFrame(String(value))),
      row("nearClip", "float", current.near_clip_distance, number("near_clip_distance"), 0.001),
      row("invertZ", "bool", current.invert_z_axis, (value) => view.update({ invert_z_axis: value === true })),
      row("shapeSize", "float", current.focal_shape_size, number("focal_shape_size"), 0.001),
      row("shapeFixed", "bool", current.focal_shape_fixed_size, (value) =>
        view.update({ focal_shape_fixed_size: value === true }),
      ),
    ];
  }
}
