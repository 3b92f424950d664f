import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { MotionCommand, MotionPlanningState, PlanningSettings, QueryName } from "../../protocol";
import type { MotionPlanning } from "../../state/motion-planning";
import { strings } from "../../strings";
import { createTickBox } from "../../widgets/controls";
import { ChoiceSetting, NumberSetting } from "./setting-fields";
import type { Tab } from "./tab";

/** The keys of the display's settings in the file. */
const SETTING_KEYS = {
  planning_time: "MoveIt_Planning_Time",
  attempts: "MoveIt_Planning_Attempts",
  velocity_scaling: "Velocity_Scaling_Factor",
  acceleration_scaling: "Acceleration_Scaling_Factor",
  cartesian: "MoveIt_Use_Cartesian_Path",
  collision_aware: "MoveIt_Use_Constraint_Aware_IK",
  approximate: "MoveIt_Allow_Approximate_IK",
} as const satisfies Record<keyof PlanningSettings, string>;

type NumberName = "planning_time" | "attempts" | "velocity_scaling" | "acceleration_scaling";
type TickName = "cartesian" | "collision_aware" | "approximate";

const LIMITS: Readonly<Record<NumberName, readonly [number, number]>> = {
  planning_time: [0.1, 1000],
  attempts: [1, 1000],
  velocity_scaling: [0.01, 1],
  acceleration_scaling: [0.01, 1],
};

/** The tab "Planning": commands, their result, start and goal state, and the settings of requests. */
export class PlanningTab implements Tab {
  readonly element: HTMLElement;
  private readonly commands: Readonly<Record<MotionCommand, HTMLButtonElement>>;
  private readonly result = h("p", { class: "planning-result", role: "status" });
  private readonly warning = h("p", { class: "note wrong", role: "status" });
  private readonly group: ChoiceSetting;
  private readonly queries: Readonly<Record<QueryName, ChoiceSetting>>;
  private readonly pipeline: ChoiceSetting;
  private readonly planner: ChoiceSetting;
  private readonly numbers: Readonly<Record<NumberName, NumberSetting>>;
  private readonly ticks: Readonly<Record<TickName, ReturnType<typeof createTickBox>>>;

  constructor(private readonly planning: MotionPlanning) {
    const texts = strings.motionPlanning;
    const createCommand = (command: MotionCommand, className = "tool framed"): HTMLButtonElement =>
      createButton(texts.hints[command], () => planning.send({ type: "command_motion", command }), className, texts.commands[command]);
    this.commands = {
      plan: createCommand("plan", "tool framed primary"),
      execute: createCommand("execute"),
      plan_and_execute: createCommand("plan_and_execute"),
      stop: createCommand("stop"),
    };
    this.group = new ChoiceSetting(texts.group, (group) => planning.setProperty("Planning Request/Planning Group", group));
    this.queries = { start: this.createQuery("start"), goal: this.createQuery("goal") };
    const sendPlanner = (pipeline: string, planner: string): void => planning.send({ type: "choose_planner", pipeline, planner });
    this.pipeline = new ChoiceSetting(texts.pipeline, (pipeline) => sendPlanner(pipeline, ""));
    this.planner = new ChoiceSetting(texts.planner, (planner) => sendPlanner(this.pipeline.value, planner));
    const createNumber = (name: NumberName, unit = ""): NumberSetting =>
      new NumberSetting(texts.settings[name], texts.settingHints[name], unit, LIMITS[name], (value) => planning.setProperty(SETTING_KEYS[name], name === "attempts" ? Math.round(value) : value));
    this.numbers = {
      planning_time: createNumber("planning_time", "s"),
      attempts: createNumber("attempts"),
      velocity_scaling: createNumber("velocity_scaling"),
      acceleration_scaling: createNumber("acceleration_scaling"),
    };
    const createTick = (name: TickName): ReturnType<typeof createTickBox> =>
      createTickBox(texts.settings[name], texts.settingHints[name], (isTicked) => planning.setProperty(SETTING_KEYS[name], isTicked));
    this.ticks = { collision_aware: createTick("collision_aware"), approximate: createTick("approximate"), cartesian: createTick("cartesian") };
    this.element = h(
      "div",
      { class: "scroll planning-tab" },
      h("div", { class: "planning-commands" }, ...Object.values(this.commands)),
      this.result,
      this.warning,
      ...[this.group, this.queries.start, this.queries.goal, this.pipeline, this.planner].map(({ element }) => element),
      ...Object.values(this.numbers).map(({ element }) => element),
      ...Object.values(this.ticks),
    );
  }

  show(state: MotionPlanningState): void {
    const texts = strings.motionPlanning;
    const isIdle = state.activity === "idle";
    const isReady = isIdle && state.missing === "none";
    this.commands.plan.disabled = this.commands.plan_and_execute.disabled = !isReady;
    this.commands.execute.disabled = !isReady || !state.executable;
    this.commands.stop.disabled = isIdle;
    this.result.textContent = describeResult(state);
    this.result.dataset["outcome"] = isIdle ? state.outcome : "none";
    this.warning.textContent = describeWarning(state);
    this.group.show(state.group, state.groups.map((name) => [name, name]));
    const named = state.states.map((name) => [name, name] as const);
    for (const [query, setting] of Object.entries(this.queries) as [QueryName, ChoiceSetting][]) {
      const special = (["<current>", "<random valid>", "<random>", query === "goal" ? "<same as start>" : "<same as goal>"] as const).map((choice) => [choice, texts.choices[choice]] as const);
      setting.show(state[query], [...special, ...named], texts.changed);
    }
    this.showPlanners(state);
    for (const [name, setting] of Object.entries(this.numbers) as [NumberName, NumberSetting][]) setting.show(state.settings[name]);
    for (const [name, tick] of Object.entries(this.ticks) as [TickName, ReturnType<typeof createTickBox>][]) tick.box.checked = state.settings[name];
  }

  private createQuery(query: QueryName): ChoiceSetting {
    const texts = strings.motionPlanning;
    const choose = (choice: string): void => this.planning.send({ type: "choose_query_state", query, choice });
    const again = createButton(texts.againHints[query], () => setting.value !== "" && choose(setting.value), "tool", createIcon("reset"));
    const setting = new ChoiceSetting(texts.queries[query], choose, again);
    return setting;
  }

  private showPlanners(state: MotionPlanningState): void {
    const { byDefault } = strings.motionPlanning;
    const pipelines = state.pipelines.map(({ id, title }) => [id, title === "" || title === id ? id : `${id} (${title})`] as const);
    this.pipeline.show(state.pipeline, [["", byDefault], ...pipelines]);
    const planners = (state.pipelines.find(({ id }) => id === state.pipeline) ?? state.pipelines[0])?.planners ?? [];
    this.planner.show(state.planner, [["", byDefault], ...planners.map((name) => [name, name] as const)]);
  }
}

function describeResult(state: MotionPlanningState): string {
  const texts = strings.motionPlanning;
  if (state.missing !== "none") return texts.missing[state.missing];
  if (state.activity !== "idle") return texts.activities[state.activity];
  const reasons: Readonly<Record<string, string>> = texts.reasons;
  const reason = state.error in reasons ? `${reasons[state.error] ?? ""} (${state.error})` : state.error;
  switch (state.outcome) {
    case "none":
      return state.draggable ? texts.ready : texts.readyWithoutHandle;
    case "planned":
      return texts.planned(state.planning_time, state.duration);
    case "executed":
      return texts.executed;
    case "stopped":
      return texts.stopped;
    case "path_cut":
      return texts.pathCut(Math.floor(100 * state.fraction));
    case "planning_failed":
      return texts.planningFailed(reason);
    case "execution_failed":
      return texts.executionFailed(reason);
  }
}

function describeWarning(state: MotionPlanningState): string {
  const texts = strings.motionPlanning;
  if (state.unreachable.length > 0) return texts.unreachable;
  return state.colliding.length > 0 ? texts.colliding(state.colliding.join(", ")) : "";
}
