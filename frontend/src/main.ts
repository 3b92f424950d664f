import "dockview/dist/styles/dockview.css";
import "./styles/theme.css";
import "./styles/layout.css";
import "./styles/tree.css";
import "./styles/controls.css";
import "./styles/scene.css";
import "./styles/panels.css";
import "./styles/shell.css";
import "./styles/images.css";
import "./styles/description.css";
import "./styles/monitor.css";
import "./styles/plots.css";
import "./styles/modeling.css";
import "./styles/voice.css";
import "./styles/timeline.css";
import "./styles/comparison.css";
import "./styles/editing.css";
import "./styles/learning.css";
import { Connection, createSocketUrl } from "./connection/connection";
import { Tokens, type AddressBar } from "./connection/tokens";
import { createButton, coalesce, h, isFramed } from "./dom";
import { publishInspection } from "./inspection";
import { ComparisonPanel } from "./panels/description/comparison-panel";
import { DiagnosticsPanel } from "./panels/description/diagnostics-panel";
import { DiagramPanel } from "./panels/description/diagram-panel";
import { LinksPanel } from "./panels/description/links-panel";
import { SourcePanel } from "./panels/description/source-panel";
import { DisplaysPanel } from "./panels/displays/displays-panel";
import { Dock } from "./panels/dock/dock";
import { FilePanels } from "./panels/dock/file-panels";
import { Layouts } from "./panels/dock/layouts";
import { EditingPanel } from "./panels/editing/editing-panel";
import { JointTablePanel } from "./panels/joints/joint-table-panel";
import { JointsPanel } from "./panels/joints/joints-panel";
import { WorldCommands } from "./panels/modeling/world-commands";
import { WorldPanel } from "./panels/modeling/world-panel";
import { preserveSearches } from "./panels/preserve-searches";
import { RequestedPanels } from "./panels/requested-panels";
import { ChecksPanel } from "./panels/learning/checks-panel";
import { LessonPanel } from "./panels/learning/lesson-panel";
import { MotionPlanningPanel } from "./panels/planning/motion-planning-panel";
import { createLivePanels } from "./panels/monitor/live-panels";
import { showTopic } from "./panels/monitor/show-topic";
import { ScenePanel } from "./panels/over-scene/scene-panel";
import type { PanelId } from "./panels/panel";
import { ProgramPanel } from "./panels/terminal/program-panel";
import { TerminalPanel } from "./panels/terminal/terminal-panel";
import { TimeFold } from "./panels/timeline/time-fold";
import { TurtlesimPanel } from "./panels/turtlesim/turtlesim-panel";
import { TimePanel } from "./panels/timeline/time-panel";
import { TimelineBar } from "./panels/timeline/timeline-bar";
import { SelectionPanel } from "./panels/views-and-tools/selection-panel";
import { ToolPropertiesPanel } from "./panels/views-and-tools/tool-properties-panel";
import { HelpPanel } from "./panels/views-and-tools/help-panel";
import { TransformationPanel } from "./panels/views-and-tools/transformation-panel";
import { VisualToolsPanel } from "./panels/monitor/visual-tools-panel";
import { ViewsPanel } from "./panels/views-and-tools/views-panel";
import { bindTalkKey } from "./panels/voice/talk-button";
import { VoicePanel } from "./panels/voice/voice-panel";
import { Controls } from "./scene/controls";
import type { PanelHost } from "./scene/displays/display-panel";
import type { PartHandles } from "./scene/editing/part-handles";
import { JointDrag } from "./scene/joint-drag";
import type { TipHandles } from "./scene/tip-handles";
import { Keyboard, LETTER_INPUT_SELECTOR } from "./scene/keyboard";
import { SERVER_FILES } from "./scene/meshes/mesh-files";
import { LodMeshes } from "./scene/meshes/lod-meshes";
import type { Modeler } from "./scene/modeling/modeler";
import { Stage } from "./scene/stage";
import type { ToolEvent } from "./scene/tools/tool";
import { Toolbox } from "./scene/tools/toolbox";
import { WorldHandling } from "./scene/world-handling";
import { TokenScreen } from "./shell/token-screen";
import { FileCommands } from "./shell/file-commands";
import { bindFileKeys } from "./shell/file-keys";
import { bindFullScreenKey } from "./shell/full-screen";
import { createKeySections, KeySheet } from "./shell/key-sheet";
import { createNoWebglNotice } from "./shell/no-webgl";
import { hasOwnDisplays, ensureOwnKey } from "./shell/own-displays";
import { RecordingDrop } from "./shell/recording-drop";
import { ShareMenu } from "./shell/share-menu";
import { StatusBar } from "./shell/status-bar";
import { TitleBar } from "./shell/title-bar";
import type { CourseState } from "./state/course";
import { isSceneEmpty } from "./state/displays";
import { Session } from "./state/session";
import { THEME_CHOICES, ThemeState } from "./state/theme";
import { takeRequested } from "./requested-settings";
import { openBrowserStorage } from "./storage";
import { language, languageChosen, languageTag, strings } from "./strings";
import { matchesShortcut, SHORTCUTS } from "./widgets/shortcuts";

const CLOSE_DELAY_MS = 2000;
/** The panels that show what the configuration file contains. */
const CONFIGURATION_PANELS: readonly PanelId[] = ["displays", "views", "tool-properties"];

function start(app: HTMLElement): void {
  document.documentElement.lang = languageTag;
  const theme = new ThemeState(document.documentElement, openBrowserStorage(), matchMedia("(prefers-color-scheme: light)"));
  const requestedTheme = takeRequested("theme", location, history);
  const themeChoice = THEME_CHOICES.find((choice) => choice === requestedTheme);
  if (themeChoice) theme.choose(themeChoice);
  const ownKey = hasOwnDisplays(location.href) ? ensureOwnKey(openBrowserStorage("sessionStorage")) : null;
  const tokens = new Tokens(createAddressBar(), openBrowserStorage());
  const connection = new Connection(createSocketUrl(location.href, ownKey, language), tokens);
  const tokenScreen = new TokenScreen(connection, tokens, app);
  // Connect before drawing anything, because the answer takes some time.
  connection.open();
  // Browsers slow down the timers of hidden pages, the retry timer among them.
  document.addEventListener("visibilitychange", () => {
    if (!document.hidden) connection.retryNow();
  });
  const session = new Session(connection);
  languageChosen.on(() => session.pageMemory.store());

  const keySheet = new KeySheet(session.tools);
  let modeler: Modeler | null = null;
  let handles: PartHandles | null = null;
  let tipHandles: TipHandles | null = null;
  const worldCommands = new WorldCommands(session.modeling, () => modeler?.escape());
  const scenePanel = new ScenePanel(
    session,
    worldCommands,
    () => stage?.fit(),
    () => dock.open("diagnostics"),
    () => keySheet.toggle(),
  );
  const dockBox = h("main", { class: "dock" });
  app.append(dockBox);
  const [sourcePanel, diagramPanel] = [new SourcePanel(session), new DiagramPanel(session)];
  const voicePanel = new VoicePanel(session.voice, session.enrolledWords);
  const lessonPanel = new LessonPanel(session.course);
  const terminalPanel = new TerminalPanel(session.terminals, theme);
  const panels = [
    scenePanel,
    new DisplaysPanel(session),
    new ViewsPanel(session),
    new ToolPropertiesPanel(session),
    new SelectionPanel(session, (item) => stage?.picker.describe(item) ?? null),
    new TimePanel(session.time, () => dock.close("time")),
    new TransformationPanel(),
    new HelpPanel(session.tools, () => createKeySections(session.tools)),
    new VisualToolsPanel(connection),
    new JointsPanel(session),
    new LinksPanel(session),
    diagramPanel,
    sourcePanel,
    new JointTablePanel(session),
    new DiagnosticsPanel(session),
    new WorldPanel(session.modeling, session.angleUnits, worldCommands),
    new ComparisonPanel(session, () => stage?.fit()),
    new EditingPanel(session),
    new MotionPlanningPanel(session),
    voicePanel,
    terminalPanel,
    new ProgramPanel(session.terminals, theme),
    lessonPanel,
    new ChecksPanel(session.course),
    new TurtlesimPanel(session.turtlesim, session.monitor.teleop, () => dock.open("teleop")),
    ...createLivePanels(session.monitor, (id) => dock.open(id), (topic) => showTopic(session, topic)),
  ];
  preserveSearches(panels, session.pageMemory);
  const dock = new Dock(dockBox, panels, new Layouts(openBrowserStorage()), openBrowserStorage());
  followAvailability(dock, session);
  new FilePanels(connection, dock);
  new RequestedPanels(connection, session.monitor, {
    open: (id) => dock.open(id),
    openDisplayPanel: (id) => dock.displayPanels.bringToFront(id, isSceneEmpty(session.displays)),
    revealDisplay: (id) => {
      const display = session.displays.find(id);
      if (display) session.displays.rowRequested.emit(display);
    },
  });

  session.description.placeRequested.on(({ file, line, display, name }) => {
    dock.open("source");
    sourcePanel.reveal(file, line, { display, name });
  });

  session.course.availabilityChanged.on(() => {
    if (!session.course.course) return;
    const { folder, file } = session.course.course;
    sourcePanel.openWorkspace(folder);
    if (file !== "") void sourcePanel.edit(file);
  });
  session.course.fileRequested.on((path) => {
    dock.open("source");
    void sourcePanel.edit(path);
  });

  session.enrolledWords.enrollRequested.on(() => {
    dock.open("voice");
    voicePanel.enrollHere();
  });

  session.editing.editRequested.on(() => dock.open("editing"));

  const stage = createStage(scenePanel.container, session, dock.displayPanels, theme);
  if (stage) scenePanel.connectScene(stage.uncoveredArea);
  worldCommands.bindKeys();
  const toolbox = stage && connectTools(stage, session, (event) => {
    if (tipHandles?.onPointer(event) || handles?.onPointer(event)) return null;
    return modeler ? modeler.onPointer(event) : event;
  });
  if (stage) {
    loadModeler(stage, session, (newModeler) => (modeler = newModeler));
    loadPartHandles(stage, session, (newHandles) => (handles = newHandles));
    loadTipHandles(stage, session, (newHandles) => (tipHandles = newHandles));
  }
  const fileCommands = new FileCommands(session.configuration);
  const titleBar = new TitleBar(session, dock, fileCommands, new RecordingDrop(session, tokens), theme, new ShareMenu(session, stage, tokens));
  app.prepend(titleBar.element);
  if (isFramed()) {
    document.documentElement.classList.add("framed");
    const openTab = (): unknown => window.open(tokens.link, "_blank", "noopener");
    titleBar.element.append(createButton(strings.shell.openTabHint, openTab, "tool", strings.shell.openTab));
  }
  bindFileKeys(session.configuration, fileCommands, sourcePanel, panels.filter(({ id }) => CONFIGURATION_PANELS.includes(id)).map(({ element }) => element));
  bindCourseKeys(session.course);
  const timeFold = new TimeFold(session.time, dock.strip);
  app.append(h("div", { class: "foot" }, new TimelineBar(session).element, timeFold.element, new StatusBar(session, stage).element));
  document.body.append(tokenScreen.element);
  bindFullScreenKey(scenePanel.box);
  document.addEventListener("keydown", (event) => {
    const isTyping = event.target instanceof HTMLInputElement || event.target instanceof HTMLTextAreaElement;
    if (event.key === "?" && !isTyping) keySheet.toggle();
  });
  bindTalkKey(session.voice, LETTER_INPUT_SELECTOR);
  publishInspection(session, stage, toolbox, {
    source: () => sourcePanel.inspect(),
    diagram: () => diagramPanel.inspect(),
    monitor: () => session.monitor.inspect(),
    voice: () => session.voice.inspect(),
    editing: () => handles?.inspect() ?? {},
    tip: () => tipHandles?.inspect() ?? {},
    terminal: () => terminalPanel.inspect(),
    lesson: () => lessonPanel.inspect(),
    turtlesim: () => session.turtlesim.inspect(),
  });
}

function createAddressBar(): AddressBar {
  return {
    get href() {
      return location.href;
    },
    moveTo: (href) => history.replaceState(history.state, "", href),
  };
}

/** Opens and closes the panels that depend on available data, in any arrangement. */
function followAvailability(dock: Dock, session: Session): void {
  const followJoints = openWhile(dock, "joints", () => session.joints.controls !== null);
  const followWorld = openWhile(dock, "world", () => session.modeling.isActive);
  const followComparison = openWhile(dock, "comparison", () => session.comparison.compared !== null);
  const followPlanning = openWhile(dock, "motion-planning", () => session.motionPlanning.isAvailable);
  const followCourse = (["lesson", "checks"] as const).map((id) => openWhile(dock, id, () => session.course.isAvailable));
  const followTerminals = openWhile(dock, "terminal", () => session.terminals.isAvailable);
  const followPrograms = openWhile(dock, "program", () => session.terminals.programs.length > 0);
  const followTurtles = openWhile(dock, "turtlesim", () => session.turtlesim.simulators.length > 0);
  const { displays } = session;
  const pruneDisplayPanels = (): void => dock.displayPanels.prune(displays.displays.map(({ id }) => id));
  const countFindings = (): void => dock.setCount("diagnostics", session.diagnostics.length + displays.failingCount);
  const countBeforePaint = coalesce(countFindings);
  session.joints.controlsChanged.on(followJoints);
  session.modeling.changed.on(followWorld);
  session.comparison.changed.on(followComparison);
  session.terminals.availabilityChanged.on(followTerminals);
  session.motionPlanning.availabilityChanged.on(followPlanning);
  session.turtlesim.simulatorsChanged.on(followTurtles);
  session.terminals.programsChanged.on((hasNew) => {
    followPrograms();
    if (hasNew) dock.open("program");
  });
  session.course.availabilityChanged.on(() => followCourse.forEach((follow) => follow()));
  displays.treeChanged.on(pruneDisplayPanels);
  session.diagnosticsChanged.on(countFindings);
  displays.treeChanged.on(countBeforePaint);
  displays.statusChanged.on(countBeforePaint);
  displays.enabledChanged.on(countBeforePaint);
  dock.arrangementReplaced.on(() => {
    followJoints();
    followWorld();
    followComparison();
    followTerminals();
    followPrograms();
    followPlanning();
    followTurtles();
    followCourse.forEach((follow) => follow());
    pruneDisplayPanels();
    countFindings();
  });
}

/**
 * Returns a function that opens a panel when it has content, and closes it when it no longer has any. It closes the
 * panel after a delay: a program that is restarted soon has content again, and the panel then stays where the user
 * put it.
 */
function openWhile(dock: Dock, id: PanelId, hasContent: () => boolean): () => void {
  let closeTimer: ReturnType<typeof setTimeout> | undefined;
  return () => {
    clearTimeout(closeTimer);
    if (!hasContent()) closeTimer = setTimeout(() => dock.close(id), CLOSE_DELAY_MS);
    else if (!dock.isOpen(id)) dock.open(id);
  };
}

/** Connects mouse and keys to the scene. */
function connectTools(stage: Stage, session: Session, passToModeler: (event: ToolEvent) => ToolEvent | null): Toolbox {
  const toolbox = new Toolbox(stage, session);
  const joints = new JointDrag(stage, session);
  const worlds = new WorldHandling(stage, session);
  const controls = new Controls(stage, session.view, (event) => {
    if (joints.onPointer(event)) return;
    const remainingEvent = passToModeler(event);
    if (remainingEvent && !worlds.onPointer(remainingEvent)) toolbox.current.onPointer(remainingEvent);
  });
  new Keyboard(session, stage, toolbox, controls);
  return toolbox;
}

/** Loads the code for modeling the world when it is first needed. */
function loadModeler(stage: Stage, session: Session, onLoaded: (modeler: Modeler) => void): void {
  const unsubscribe = session.modeling.changed.on(() => {
    if (!session.modeling.isActive) return;
    unsubscribe();
    void import("./scene/modeling/modeler").then(({ Modeler }) => onLoaded(new Modeler(stage, session)));
  });
}

/** Loads the handles of a robot's parts when a part is first edited. */
function loadPartHandles(stage: Stage, session: Session, onLoaded: (handles: PartHandles) => void): void {
  const unsubscribe = session.editing.changed.on(() => {
    if (!session.editing.isActive) return;
    unsubscribe();
    void import("./scene/editing/part-handles").then(({ PartHandles }) => onLoaded(new PartHandles(stage, session)));
  });
}

/** Loads the handles on the tip of a chain when a tip is first dragged. */
function loadTipHandles(stage: Stage, { tipSwitch, frames }: Session, onLoaded: (handles: TipHandles) => void): void {
  const unsubscribe = tipSwitch.changed.on(() => {
    const { drag } = tipSwitch;
    if (!drag) return;
    unsubscribe();
    void import("./scene/tip-handles").then(({ TipHandles }) => onLoaded(new TipHandles(stage, drag, frames)));
  });
}

/** Binds the keys of the course, which work everywhere except in dialogs. */
function bindCourseKeys(course: CourseState): void {
  const bindings = [
    { shortcut: SHORTCUTS.previousStep, run: () => course.moveBy(-1) },
    { shortcut: SHORTCUTS.nextStep, run: () => course.moveBy(1) },
    { shortcut: SHORTCUTS.checkStep, run: () => course.check() },
  ];
  const onKeyDown = (event: KeyboardEvent): void => {
    const binding = bindings.find(({ shortcut }) => matchesShortcut(event, shortcut));
    if (!binding || !course.isAvailable || (event.target instanceof Element && event.target.closest("dialog"))) return;
    event.preventDefault();
    event.stopPropagation();
    binding.run();
  };
  document.addEventListener("keydown", onKeyDown, true);
}

/** Creates the scene; returns null without WebGL, where everything else still works. */
function createStage(container: HTMLElement, session: Session, panels: PanelHost, theme: ThemeState): Stage | null {
  try {
    return new Stage(container, session, panels, theme, SERVER_FILES, new LodMeshes(createLodMeshWorker));
  } catch (error) {
    console.warn(error);
    container.append(createNoWebglNotice());
    return null;
  }
}

/** Starts the worker. The expression must have this form for Vite to bundle the worker as a separate file. */
function createLodMeshWorker(): Worker {
  return new Worker(new URL("./scene/meshes/lod-mesh-worker.ts", import.meta.url), { type: "module" });
}

const app = document.getElementById("app");
if (app) start(app);
