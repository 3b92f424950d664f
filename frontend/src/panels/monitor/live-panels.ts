import type { MonitorState } from "../../state/monitor/monitor";
import type { Panel, PanelId } from "../panel";
import { ControllersPanel } from "./controllers-panel";
import { LogPanel } from "./log-panel";
import { NavigationPanel } from "./navigation-panel";
import { NodeGraphPanel } from "./node-graph-panel";
import { ParametersPanel } from "./parameters-panel";
import { PlotPanel } from "./plot-panel";
import { PublishersPanel } from "./publishers-panel";
import { ServicesPanel } from "./services-panel";
import { TeleopPanel } from "./teleop-panel";
import { TopicsPanel } from "./topics-panel";
import { TrajectoriesPanel } from "./trajectories-panel";

/** Creates the panels for live data; `open` brings one to the front, `showTopic` adds the display of a topic. */
export function createLivePanels(monitor: MonitorState, open: (id: PanelId) => void, showTopic: (topic: string) => void): Panel[] {
  const { plots, topics } = monitor;
  const plotField = (topic: string, path: string): void => {
    open("plot");
    plots.addSeries(plots.plots[0] ?? plots.addPlot(), { topic, path });
  };
  return [
    new PlotPanel(plots, topics),
    new TopicsPanel(topics, plotField, showTopic),
    new NodeGraphPanel(monitor.graph),
    new ParametersPanel(monitor.parameters),
    new LogPanel(monitor.log),
    new ServicesPanel(monitor.services),
    new PublishersPanel(monitor.publishers, topics),
    new ControllersPanel(monitor.controllers),
    new TrajectoriesPanel(monitor.trajectories),
    new TeleopPanel(monitor.teleop),
    new NavigationPanel(monitor.navigation),
  ];
}
