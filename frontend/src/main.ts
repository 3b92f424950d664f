import "dockview-core/dist/styles/dockview.css";
import "./styles/theme.css";
import "./styles/layout.css";
import "./styles/tree.css";
import "./styles/controls.css";
import "./styles/scene.css";
import "./styles/panels.css";
import { Connection, socketUrl } from "./connection/connection";
import { h } from "./dom";
import { publishInspection } from "./inspection";
import { DiagnosticsPanel } from "./panels/diagnostics-panel";
import { DisplaysPanel } from "./panels/displays-panel";
import { Dock } from "./panels/dock";
import { JointsPanel } from "./panels/joints-panel";
import { ScenePanel } from "./panels/scene-panel";
import { StatusBar } from "./panels/status-bar";
import { TitleBar } from "./panels/title-bar";
import { ViewsPanel } from "./panels/views-panel";
import { Controls } from "./scene/controls";
import { Stage } from "./scene/stage";
import { Session } from "./state/session";
import { language, strings } from "./strings";

function start(app: HTMLElement): void {
  document.documentElement.lang = language === "zh" ? "zh-CN" : "en";
  const connection = new Connection(socketUrl(location.href));
  // Before anything is drawn: the answer takes a moment.
  connection.open();
  const session = new Session(connection);

  const scene = new ScenePanel(session, () => dock.open("diagnostics"));
  const dockBox = h("main", { class: "dock" });
  app.append(dockBox);
  const dock = new Dock(dockBox, [
    scene,
    new DisplaysPanel(session),
    new ViewsPanel(session),
    new JointsPanel(session),
    new DiagnosticsPanel(session),
  ]);
  session.joints.controlsChanged.on(() => {
    if (session.joints.controls === null) dock.close("joints");
    else if (!dock.isOpen("joints")) dock.open("joints");
  });

  session.diagnosticsChanged.on(() => dock.setCount("diagnostics", session.diagnostics.length));

  const stage = makeStage(scene.container, session);
  if (stage) new Controls(stage, session.view);
  app.prepend(new TitleBar(session, dock).element);
  app.append(new StatusBar(session, stage).element);
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") session.selection.select(null);
  });
  publishInspection(session, stage);
}

/** Without WebGL everything else still works. */
function makeStage(container: HTMLElement, session: Session): Stage | null {
  try {
    return new Stage(container, session);
  } catch (error) {
    console.error(error);
    container.append(h("p", { class: "no-webgl" }, strings.scene.noWebgl));
    return null;
  }
}

const app = document.getElementById("app");
if (app) start(app);
