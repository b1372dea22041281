// The data behind the figures as files, made on the page; nothing is fetched.
const statusNames = { o: "ok", p: "partly_filled", m: "missing", s: "suspect" };

const quote = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** A true minus sign and thousands separators are for people; files get plain numbers. */
function plainCell(text) {
  const number = text.trim().replace("−", "-");
  if (/^-?\d{1,3}(,\d{3})+(\.\d+)?$/.test(number)) return number.replaceAll(",", "");
  if (/^-?\d+(\.\d+)?$/.test(number)) return number;
  return quote(text.trim().replaceAll("\u00a0", " "));
}

/** Headings inside the table become a column of their own. */
function tableCsv(table) {
  const grouped = table.querySelector("th.group") !== null;
  const columns = [...[...table.tHead.rows].at(-1).cells].map((cell) =>
    plainCell(cell.textContent),
  );
  const lines = [(grouped ? ["Part", ...columns] : columns).join(",")];
  let group = "";
  for (const row of table.tBodies[0].rows) {
    const cells = [...row.cells].map((cell) => plainCell(cell.textContent));
    if (row.cells[0].classList.contains("group")) group = cells[0];
    else lines.push((grouped ? [group, ...cells] : cells).join(","));
  }
  return `${lines.join("\n")}\n`;
}

function hourlyCsv(load) {
  const lines = ["local_day,hour,mean_kW,status"];
  const first = Date.parse(`${load.firstDay}T00:00:00Z`);
  for (let i = 0; i < load.status.length; i++) {
    const day = new Date(first + Math.floor(i / 24) * 86_400_000).toISOString().slice(0, 10);
    lines.push(`${day},${i % 24},${load.kW[i] ?? ""},${statusNames[load.status[i]]}`);
  }
  return `${lines.join("\n")}\n`;
}

function save(name, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  link.download = `${name
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, "-")
    .replace(/^-|-$/g, "")}.csv`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

function addButton(details, label, onClick) {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = label;
  button.addEventListener("click", onClick);
  details.querySelector("summary").after(button);
}

/** Gives each figure's table a button that saves it; load figures also one for their hours. */
export function addDownloads(data) {
  for (const details of document.querySelectorAll("details.data")) {
    const table = details.querySelector("table");
    const name = table.parentElement.getAttribute("aria-label");
    addButton(details, "Save this table as CSV", () => save(name, tableCsv(table)));
    const plot = details.closest("figure")?.querySelector('[data-figure="load"]');
    if (plot) {
      const load = data.loads[plot.dataset.index];
      addButton(details, "Save all hours as CSV", () =>
        save(`${load.label} hours`, hourlyCsv(load)),
      );
    }
  }
}
