import "../../styles/planning.css";
import { h } from "../../dom";
import type { MotionPlanningState } from "../../protocol";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { JointsTab } from "./joints-tab";
import { ObjectsTab } from "./objects-tab";
import { PlanningTab } from "./planning-tab";
import type { Tab } from "./tab";

type TabName = keyof typeof strings.motionPlanning.tabs;

/** The tabs of the MotionPlanning panel, as in RViz. */
export class PlanningDeck {
  readonly element: HTMLElement;
  private readonly tabs: Readonly<Record<TabName, Tab>>;
  private readonly buttons = new Map<TabName, HTMLButtonElement>();
  private chosen: TabName = "planning";
  private state: MotionPlanningState | null = null;

  constructor(session: Session) {
    this.tabs = { planning: new PlanningTab(session.motionPlanning), joints: new JointsTab(session.motionPlanning, session.angleUnits), objects: new ObjectsTab(session.motionPlanning, session.angleUnits) };
    const bar = h("div", { class: "segmented planning-tabs", role: "tablist", aria: { label: strings.motionPlanning.tabsLabel } });
    const pages = this.names.map((name) => {
      const { element } = this.tabs[name];
      const button = h("button", { role: "tab", aria: { controls: `planning-${name}` }, onClick: () => this.choose(name) }, strings.motionPlanning.tabs[name]);
      button.type = "button";
      button.id = `planning-tab-${name}`;
      this.buttons.set(name, button);
      bar.append(button);
      element.id = `planning-${name}`;
      element.role = "tabpanel";
      element.setAttribute("aria-labelledby", button.id);
      return element;
    });
    bar.addEventListener("keydown", (event) => this.onTabKey(event));
    this.element = h("div", { class: "planning-deck" }, bar, ...pages);
    this.choose("planning");
  }

  show(state: MotionPlanningState): void {
    this.state = state;
    this.tabs[this.chosen].show(state);
  }

  private get names(): TabName[] {
    return Object.keys(this.tabs) as TabName[];
  }

  private choose(name: TabName): void {
    this.chosen = name;
    for (const [other, button] of this.buttons) {
      const isChosen = other === name;
      button.classList.toggle("on", isChosen);
      button.setAttribute("aria-selected", String(isChosen));
      button.tabIndex = isChosen ? 0 : -1;
      this.tabs[other].element.hidden = !isChosen;
    }
    if (this.state) this.show(this.state);
  }

  private onTabKey(event: KeyboardEvent): void {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const { names } = this;
    const name = names[(names.indexOf(this.chosen) + step + names.length) % names.length];
    if (!name) return;
    this.choose(name);
    this.buttons.get(name)?.focus();
  }
}
