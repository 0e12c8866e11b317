// Before the page is shown: remembers errors of scripts where a test finds them, and the look that the reader chose.
"use strict";
addEventListener("error", (event) => {
  document.documentElement.dataset.error = event.message || "a script failed";
});
try {
  const theme = localStorage.getItem("noslip-theme");
  if (theme === "dark" || theme === "light") document.documentElement.dataset.theme = theme;
} catch {
  // No storage, as in some browsers for pages from a disk: then every page starts with the system's look.
}
