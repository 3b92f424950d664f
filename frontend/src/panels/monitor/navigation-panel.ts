import { createButton, h } from "../../dom";
import type { NavigationCommand } from "../../protocol";
import type { NavigationState } from "../../state/monitor/navigation";
import { strings } from "../../strings";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";

type RowName = "navigation" | "localization" | "goal" | "eta" | "distance" | "elapsed" | "recoveries";

const ROW_NAMES: readonly RowName[] = ["navigation", "localization", "goal", "eta", "distance", "elapsed", "recoveries"];

/** nav2's panel "Navigation 2": states of the nodes, progress of the goal, and commands. */
export class NavigationPanel implements Panel {
  readonly id = "navigation";
  readonly icon = "navigation";
  readonly element: HTMLElement;
  private readonly values: Record<RowName, HTMLElement>;
  private readonly buttons: Record<NavigationCommand, HTMLButtonElement>;
  private readonly problem = h("p", { class: "note wrong", aria: { live: "polite" } });

  constructor(private readonly state: NavigationState) {
    const texts = strings.monitor.navigation;
    const createValue = (): HTMLElement => h("output", { class: "navigation-value numeric" });
    this.values = {
      navigation: createValue(),
      localization: createValue(),
      goal: createValue(),
      eta: createValue(),
      distance: createValue(),
      elapsed: createValue(),
      recoveries: createValue(),
    };
    const createCommandButton = (command: NavigationCommand): HTMLButtonElement =>
      createButton(texts.hints[command], () => state.sendCommand(command), "tool", texts.commands[command]);
    this.buttons = {
      startup: createCommandButton("startup"),
      pause: createCommandButton("pause"),
      resume: createCommandButton("resume"),
      reset: createCommandButton("reset"),
      cancel: createCommandButton("cancel"),
    };
    this.element = h(
      "div",
      { class: "panel monitor" },
      h(
        "div",
        { class: "scroll navigation" },
        h("div", { class: "toolbar navigation-buttons" }, ...Object.values(this.buttons)),
        h("dl", { class: "navigation-rows" }, ...ROW_NAMES.flatMap((row) => [h("dt", { class: "toolbar-label" }, texts.rows[row]), h("dd", {}, this.values[row])])),
        this.problem,
      ),
    );
    state.changed.on(() => this.show());
    onVisibilityChange(this.element, (isVisible) => state.setOpen(isVisible));
    this.show();
  }

  private show(): void {
    const texts = strings.monitor.navigation;
    const { lastState } = this.state;
    const setRow = (row: RowName, text: string, kind = ""): void => {
      this.values[row].textContent = text;
      this.values[row].dataset["state"] = kind;
    };
    const formatSeconds = (value: number | null | undefined): string => (value === null || value === undefined ? texts.none : texts.duration(value));
    for (const manager of ["navigation", "localization"] as const) {
      const state = lastState?.[manager] ?? "unknown";
      setRow(manager, texts.states[state], state);
    }
    const goal = lastState?.goal ?? "none";
    setRow("goal", texts.goals[goal], goal);
    setRow("eta", formatSeconds(lastState?.eta));
    setRow("elapsed", formatSeconds(lastState?.elapsed));
    setRow("distance", lastState?.distance === null || lastState?.distance === undefined ? texts.none : `${lastState.distance.toFixed(2)} m`);
    setRow("recoveries", lastState?.recoveries === null || lastState?.recoveries === undefined ? texts.none : String(lastState.recoveries));
    this.problem.textContent = lastState?.problem ?? "";
    this.updateButtons();
  }

  /** Enables the buttons whose commands are possible now. */
  private updateButtons(): void {
    const { lastState } = this.state;
    const managers = lastState ? [lastState.navigation, lastState.localization].filter((state) => state !== "unknown") : [];
    const isActive = managers.includes("active");
    const isIdle = managers.includes("inactive");
    const isPossible: Record<NavigationCommand, boolean> = {
      startup: isIdle,
      pause: isActive,
      resume: isIdle,
      reset: isActive || isIdle,
      cancel: lastState?.goal === "active",
    };
    for (const [command, element] of Object.entries(this.buttons) as [NavigationCommand, HTMLButtonElement][]) {
      element.disabled = !isPossible[command] || lastState?.busy === true;
    }
  }
}
