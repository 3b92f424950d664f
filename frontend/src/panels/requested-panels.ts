import type { Connection } from "../connection/connection";
import type { RequestedPanel } from "../protocol";
import type { MonitorState } from "../state/monitor/monitor";
import type { Plot } from "../state/monitor/plots";
import type { PanelId } from "./panel";

/** The parts of the page that requested panels use. */
export interface PanelOpener {
  open(id: PanelId): void;
  /** Brings the panel of a display to the front, now or as soon as the display has one. */
  openDisplayPanel(display: string): void;
  /** Shows the row of a display in the Displays panel, if the configuration of this page has the display. */
  revealDisplay(display: string): void;
}

/** Opens the panels that programs such as rqt_plot request, each once in a run of the program. */
export class RequestedPanels {
  private lastRun = "";
  private readonly openedNumbers = new Set<number>();
  private readonly plots = new Map<number, Plot>();

  constructor(
    connection: Connection,
    private readonly monitor: MonitorState,
    private readonly opener: PanelOpener,
  ) {
    connection.on("hello", ({ run }) => {
      if (run === this.lastRun) return;
      this.lastRun = run;
      this.openedNumbers.clear();
      this.plots.clear();
    });
    connection.on("requested_panels", ({ panels }) => panels.forEach((panel) => this.apply(panel)));
  }

  private apply(panel: RequestedPanel): void {
    if (!this.openedNumbers.has(panel.number)) {
      this.openedNumbers.add(panel.number);
      this.open(panel);
    }
    this.addSeries(panel);
  }

  private open({ panel, display, node, velocities }: RequestedPanel): void {
    const { parameters, teleop } = this.monitor;
    if (node !== null) parameters.chooseNode(node);
    if (velocities) {
      const { topic, stamped, linear, angular } = velocities;
      teleop.configure({
        topic,
        ...(stamped === null ? {} : { kind: stamped ? "TwistStamped" : "Twist" }),
        ...(linear === null ? {} : { linear }),
        ...(angular === null ? {} : { angular }),
      });
    }
    if (panel === "image") {
      if (display !== null) this.opener.openDisplayPanel(display);
      return;
    }
    this.opener.open(panel);
    if (display !== null) this.opener.revealDisplay(display);
  }

  /** Adds the requested series to the plot of the panel, which may be one of the last visit. */
  private addSeries({ number, series }: RequestedPanel): void {
    if (series.length === 0) return;
    const { plots } = this.monitor;
    const knownPlot = this.plots.get(number);
    const plot =
      (knownPlot && plots.plots.includes(knownPlot) ? knownPlot : undefined) ??
      plots.plots.find((candidate) => hasOnlyRequestedSeries(candidate, series)) ??
      plots.plots.find((candidate) => candidate.series.length === 0) ??
      plots.addPlot();
    this.plots.set(number, plot);
    for (const field of series) plots.addSeries(plot, field);
  }
}

/** Returns whether a plot has series, all of which are requested. */
function hasOnlyRequestedSeries(plot: Plot, requested: RequestedPanel["series"]): boolean {
  const isRequested = (name: { topic: string; path: string }): boolean =>
    requested.some(({ topic, path }) => topic === name.topic && path === name.path);
  return plot.series.length > 0 && plot.series.every(isRequested);
}
