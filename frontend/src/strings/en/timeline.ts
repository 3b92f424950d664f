export const timeline = {
  label: "Timeline",
  position: "Time in the recording",
  play: "Play (Space)",
  pause: "Pause (Space)",
  back: "To the message before (←)",
  forward: "To the next message (→)",
  speed: "Speed",
  loop: "Begin anew at the end",
  keys: "Recording: play, pause; step",
};
