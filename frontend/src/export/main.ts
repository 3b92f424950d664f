import "../styles/theme.css";
import "../styles/controls.css";
import "../styles/scene.css";
import "../styles/panels.css";
import "../styles/description.css";
import "../styles/comparison.css";
import "./export.css";
import { h } from "../dom";
import { publishInspection } from "../inspection";
import { CardColumn } from "../panels/over-scene/card-column";
import { OrientationSign } from "../panels/over-scene/orientation-sign";
import { SelectionCard } from "../panels/over-scene/selection-card";
import { Controls } from "../scene/controls";
import { Keyboard } from "../scene/keyboard";
import { Stage } from "../scene/stage";
import { Toolbox } from "../scene/tools/toolbox";
import { createNoWebglNotice } from "../shell/no-webgl";
import { Session } from "../state/session";
import { ThemeState } from "../state/theme";
import { openBrowserStorage } from "../storage";
import { languageChosen, languageTag, strings } from "../strings";
import { RecordedConnection } from "./recorded-connection";
import { RecordedFiles } from "./recorded-files";
import { readRecording } from "./recording";
import { Sidebar } from "./sidebar";
import { lookFrom } from "./views";

/** An exported page has no panels for the images of displays. */
const NO_PANELS = { offer: () => undefined, withdraw: () => undefined, retitle: () => undefined };

function start(app: HTMLElement, recordedElement: HTMLElement): void {
  document.documentElement.lang = languageTag;
  const theme = new ThemeState(document.documentElement, openBrowserStorage(), matchMedia("(prefers-color-scheme: light)"));
  const recording = readRecording(recordedElement);
  const { display } = recording;
  const connection = new RecordedConnection(recording);
  const session = new Session(connection);
  languageChosen.on(() => session.pageMemory.store());
  connection.open();
  const { joints } = session;
  session.pageMemory.preserve("positions", () => joints.positions, (positions) => joints.move(positions));

  const container = h("div", { class: "canvas-box", role: "region", aria: { label: strings.scene.label } });
  const cardColumn = new CardColumn();
  cardColumn.element.append(new SelectionCard(session, cardColumn).element);
  const overlay = h("div", { class: "overlay" }, cardColumn.element, new OrientationSign(session).element);
  const scene = h("main", { class: "scene-box" }, container, overlay);
  app.append(scene);
  const stage = createStage(container, session, new RecordedFiles(recording.files), theme);
  if (stage) cardColumn.connectScene(stage.uncoveredArea);
  const actions = {
    lookFrom: (side: Parameters<typeof lookFrom>[0]): void => {
      if (stage) lookFrom(side, session, stage);
    },
    fit: (): void => stage?.fit(),
    reset: (): void => {
      connection.reset();
      session.view.reset();
    },
  };
  app.append(new Sidebar(session, display, recording.program, theme, actions).element);
  const toolbox = stage && new Toolbox(stage, session);
  if (stage && toolbox) {
    const controls = new Controls(stage, session.view, (event) => toolbox.current.onPointer(event));
    new Keyboard(session, stage, toolbox, controls);
  }
  publishInspection(session, stage, toolbox, {});
}

function createStage(container: HTMLElement, session: Session, files: RecordedFiles, theme: ThemeState): Stage | null {
  try {
    return new Stage(container, session, NO_PANELS, theme, files);
  } catch (error) {
    console.warn(error);
    container.append(createNoWebglNotice());
    return null;
  }
}

const [app, recordedElement] = [document.getElementById("app"), document.getElementById("recorded")];
if (app && recordedElement) start(app, recordedElement);
