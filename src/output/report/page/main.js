// The page in its order.

firstTheme();
showTop();
const main = document.getElementById("main");
main.replaceChildren();
showHead(main);
showWarnings(main);
showTiles(main);
showRemarks(main);
const SHOWN = { run: showRun, equilibrium: showPath, modes: showModes, response: showResponse };
(SHOWN[data.kind] || showMany)();
showUncertainty();
showCell();
showEffects();
showWork();
showCase();
showFoot();
showContents();

let known = document.documentElement.clientWidth;
new ResizeObserver(() => {
  const width = document.documentElement.clientWidth;
  if (width === known) return;
  known = width;
  redraw();
}).observe(document.documentElement);
document.documentElement.dataset.ready = "yes";
