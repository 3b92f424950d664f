import type { Connection } from "../../connection/connection";
import type { TextStorage } from "../../storage";
import { ControllersState } from "./controllers";
import { formatField } from "./field-text";
import { LogState } from "./log";
import { NavigationState } from "./navigation";
import { NodeGraphState } from "./node-graph";
import { ParametersState } from "./parameters";
import { PlotsState } from "./plots";
import { PublishersState } from "./publishers";
import { ServicesState } from "./services";
import { TeleopState } from "./teleop";
import { TopicsState } from "./topics";
import { TrajectoriesState } from "./trajectories";

/** The state of the live panels. */
export class MonitorState {
  readonly topics: TopicsState;
  readonly plots: PlotsState;
  readonly graph: NodeGraphState;
  readonly parameters: ParametersState;
  readonly log: LogState;
  readonly teleop: TeleopState;
  readonly navigation: NavigationState;
  readonly services: ServicesState;
  readonly publishers: PublishersState;
  readonly controllers: ControllersState;
  readonly trajectories: TrajectoriesState;

  constructor(connection: Connection, storage: TextStorage) {
    this.topics = new TopicsState(connection);
    this.plots = new PlotsState(connection, storage);
    this.graph = new NodeGraphState(connection);
    this.parameters = new ParametersState(connection);
    this.log = new LogState(connection, storage);
    this.teleop = new TeleopState(connection, storage);
    this.navigation = new NavigationState(connection);
    this.services = new ServicesState(connection);
    this.publishers = new PublishersState(connection, storage);
    this.controllers = new ControllersState(connection);
    this.trajectories = new TrajectoriesState(connection);
  }

  /** Returns the state of all live panels for `window.linkwright`. */
  inspect(): object {
    const { plots, topics, graph, parameters, log, teleop } = this;
    return {
      plots: plots.plots.map(({ series, range }) => ({
        range,
        series: series.map((samples) => ({
          name: formatField(samples),
          error: samples.error,
          samples: samples.buffer.length,
          last: samples.buffer.lastValue,
        })),
      })),
      paused: plots.isPaused,
      window: plots.window,
      topics: topics.topics.map((topic) => ({ ...topic })),
      traffic: Object.fromEntries(topics.traffic),
      nodes: [...graph.graph.nodes],
      parameterNodes: [...parameters.nodes],
      log: { lines: log.lines.length, shown: log.shownLines.length, last: log.shownLines.at(-1)?.message ?? null },
      teleop: { aim: teleop.aim, motion: teleop.motion, settings: { ...teleop.settings } },
    };
  }
}
