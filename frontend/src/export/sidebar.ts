import { createButton, h } from "../dom";
import { createIcon } from "../icons";
import { ComparisonPanel } from "../panels/description/comparison-panel";
import { createJointBar } from "../panels/joints/joint-bar";
import { JointRow } from "../panels/joints/joint-row";
import type { View } from "../protocol";
import type { DisplayState } from "../state/displays";
import type { Session } from "../state/session";
import type { ThemeState } from "../state/theme";
import { changeLanguage, strings } from "../strings";
import { createTickBox } from "../widgets/controls";
import type { Side } from "./views";

const SIDES: readonly Side[] = ["iso", "front", "left", "top"];

/** The actions of the sidebar. */
export interface SidebarActions {
  lookFrom(side: Side): void;
  /** Moves the camera so that the whole selection is visible. */
  fit(): void;
  reset(): void;
}

/** The column beside the robot of an exported page: displays, views, and a slider for each joint. */
export class Sidebar {
  readonly element: HTMLElement;

  constructor(
    private readonly session: Session,
    private readonly display: string,
    program: string,
    theme: ThemeState,
    private readonly actions: SidebarActions,
  ) {
    const texts = strings.sharing.exported;
    const name = session.robots.get(display)?.name ?? "";
    const languageButton = createButton(
      strings.shell.languageHint,
      changeLanguage,
      "tool",
      createIcon("language"),
      strings.shell.language,
    );
    const themeButton = createButton(
      strings.shell.theme,
      () => theme.choose(theme.theme === "light" ? "dark" : "light"),
      "tool bare",
      createIcon("light"),
    );
    this.element = h(
      "aside",
      { class: "sidebar", aria: { label: texts.sidebar } },
      h("header", {}, h("h1", {}, name), themeButton, languageButton),
      this.createComparison(),
      h("section", { aria: { label: texts.shown } }, h("h2", {}, texts.shown), h("div", { class: "shown" }, ...this.createBoxes())),
      h("section", { aria: { label: texts.views } }, h("h2", {}, texts.views), h("div", { class: "sides" }, ...this.createViews())),
      this.createJoints(),
      h("footer", {}, texts.made(program)),
    );
  }

  /** Returns the differences of the two descriptions, if the file has two. */
  private createComparison(): HTMLElement | null {
    const { comparison } = this.session;
    if (comparison.compared === null) return null;
    const panel = new ComparisonPanel(this.session, () => this.actions.fit());
    return h("section", { aria: { label: strings.comparison.panel } }, h("h2", {}, strings.comparison.panel), panel.element);
  }

  private createBoxes(): HTMLElement[] {
    const texts = strings.sharing.exported;
    const { displays } = this.session.displays;
    const robot = displays.find(({ id }) => id === this.display);
    const boxes = robot ? [this.createRowBox(robot, "Visual Enabled", texts.visual), this.createRowBox(robot, "Collision Enabled", texts.collision)] : [];
    const otherDisplays = displays.filter(({ id, isGroup, isSupported }) => id !== this.display && !isGroup && isSupported && !this.session.comparison.isOld(id));
    return [...boxes, ...otherDisplays.map((otherDisplay) => this.createDisplayBox(otherDisplay))].filter((box) => box !== null);
  }

  private createRowBox(robot: DisplayState, row: string, label: string): HTMLElement | null {
    const node = robot.rows.find(row);
    if (!node) return null;
    const tickBox = createTickBox(label, label, (isTicked) => this.session.setProperty(node.id, isTicked));
    tickBox.box.checked = node.value === true;
    return tickBox;
  }

  private createDisplayBox(display: DisplayState): HTMLElement {
    const tickBox = createTickBox(display.name, display.name, (isTicked) => this.session.setProperty(display.enabledId, isTicked));
    tickBox.box.checked = display.isChecked;
    return tickBox;
  }

  private createViews(): HTMLElement[] {
    const texts = strings.sharing.exported;
    const sides = SIDES.map((side) => createButton(texts.sides[side], () => this.actions.lookFrom(side), "tool", texts.sides[side]));
    const applyView = ({ cls, values }: View): void => {
      this.session.view.setClass(cls);
      this.session.view.update(values);
    };
    const savedViewButtons = this.session.view.savedViews.map(({ view }) => createButton(view.name, () => applyView(view), "tool", view.name));
    const resetButton = createButton(texts.startHint, () => this.actions.reset(), "tool", createIcon("reset"), texts.start);
    return [...sides, ...savedViewButtons, resetButton];
  }

  private createJoints(): HTMLElement {
    const { joints, angleUnits } = this.session;
    const texts = strings.joints;
    const rows = (joints.controls ?? []).map(
      (joint) => new JointRow(joint, angleUnits, (position) => joints.move({ [joint.name]: position })),
    );
    const update = (): void => {
      for (const row of rows) row.setPosition(joints.positions[row.joint.name] ?? 0);
    };
    joints.positionsChanged.on(update);
    angleUnits.changed.on(() => rows.forEach((row) => row.showUnit()));
    update();
    const toolbar = createJointBar(this.session);
    const emptyHint = h("p", { class: "empty" }, texts.none);
    const content = rows.length > 0 ? [toolbar, h("div", { class: "joints" }, ...rows.map((row) => row.element))] : [emptyHint];
    return h("section", { class: "joint-section", aria: { label: strings.sharing.exported.joints } }, h("h2", {}, strings.sharing.exported.joints), ...content);
  }
}
