import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { RequestedPanels } from "../src/panels/requested-panels";
import type { RequestedPanel, ServerMessage } from "../src/protocol";
import { MonitorState } from "../src/state/monitor/monitor";

/** A page whose dock records what it opens. */
class BarePage {
  readonly opened: string[] = [];
  readonly monitor: MonitorState;
  private readonly connection = new Connection("ws://localhost/ws");

  constructor() {
    vi.spyOn(this.connection, "send").mockImplementation(() => undefined);
    const texts = new Map<string, string>();
    const storage = { getItem: (key: string) => texts.get(key) ?? null, setItem: (key: string, text: string) => void texts.set(key, text) };
    this.monitor = new MonitorState(this.connection, storage);
    new RequestedPanels(this.connection, this.monitor, {
      open: (id) => this.opened.push(id),
      openDisplayPanel: (display) => this.opened.push(`panel of ${display}`),
      revealDisplay: (display) => this.opened.push(`row of ${display}`),
    });
    this.greet("first");
  }

  greet(run: string): void {
    this.receive({ type: "hello", protocol: 0, version: "", title: "", run });
  }

  request(...panels: Partial<RequestedPanel>[]): void {
    const defaults: Omit<RequestedPanel, "number"> = { panel: "graph", display: null, series: [], node: null, velocities: null };
    this.receive({ type: "requested_panels", panels: panels.map((panel, index) => ({ number: index + 1, ...defaults, ...panel })) });
  }

  private receive(message: ServerMessage): void {
    this.connection.message.emit(message);
  }

  get plots(): string[][] {
    return this.monitor.plots.plots.map(({ series }) => series.map(({ topic, path }) => `${topic}.${path}`));
  }
}

describe("requested panels", () => {
  let page: BarePage;
  beforeEach(() => {
    page = new BarePage();
  });

  it("open once in a run of the program", () => {
    page.request({ panel: "graph" });
    page.request({ panel: "graph" }, { panel: "log" });
    expect(page.opened).toEqual(["graph", "log"]);
    page.greet("first");
    page.request({ panel: "graph" });
    expect(page.opened).toEqual(["graph", "log"]);
    page.greet("second");
    page.request({ panel: "graph" });
    expect(page.opened).toEqual(["graph", "log", "graph"]);
  });

  it("show the image of a display, or its row", () => {
    page.request({ panel: "image", display: "4" }, { panel: "displays", display: "5" });
    expect(page.opened).toEqual(["panel of 4", "displays", "row of 5"]);
  });

  it("choose a node, and configure the velocities", () => {
    page.request(
      { panel: "parameters", node: "/arm" },
      { panel: "teleop", velocities: { topic: "/drive", stamped: true, linear: 2, angular: null } },
    );
    expect(page.monitor.parameters.node).toBe("/arm");
    expect(page.monitor.teleop.settings).toMatchObject({ topic: "/drive", kind: "TwistStamped", linear: 2, angular: 1 });
  });

  it("plot the fields of one program together, also those that arrive later", () => {
    const x = { topic: "/odom", path: "x" };
    const y = { topic: "/odom", path: "y" };
    page.request({ panel: "plot" });
    page.request({ panel: "plot", series: [x] });
    page.request({ panel: "plot", series: [x, y] });
    expect(page.plots).toEqual([["/odom.x", "/odom.y"]]);
    page.request({ panel: "plot", series: [x, y] }, { panel: "plot", series: [{ topic: "/imu", path: "z" }] });
    expect(page.plots).toEqual([["/odom.x", "/odom.y"], ["/imu.z"]]);
  });

  it("use the plot of the last visit again, and keep plots of the user", () => {
    const plot = page.monitor.plots.addPlot();
    page.monitor.plots.addSeries(plot, { topic: "/own", path: "x" });
    const series = [{ topic: "/odom", path: "x" }];
    page.request({ panel: "plot", series });
    page.greet("second");
    page.request({ panel: "plot", series });
    expect(page.plots).toEqual([["/own.x"], ["/odom.x"]]);
  });
});
