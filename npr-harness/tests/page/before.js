// Put before the page's own script: collects what goes wrong.
window.findings = [];
window.addEventListener("error", (event) => findings.push(`error: ${event.message || event.target.outerHTML}`), true);
window.addEventListener("unhandledrejection", (event) => findings.push(`rejection: ${event.reason}`));
for (const level of ["error", "warn"]) {
  console[level] = (...what) => findings.push(`console.${level}: ${what.join(" ")}`);
}
