"""Tables of cells as files: delimited text in several encodings, and workbooks."""
import dataclasses
import datetime
import io
import re
import zipfile
from xml.sax.saxutils import escape


@dataclasses.dataclass(frozen=True)
class Number:
    """A measured value: text by the file's habits in delimited text, a number in a workbook."""
    value: float
    decimals: int
    suffix: str = ""


@dataclasses.dataclass(frozen=True)
class Moment:
    """A wall time: text in that format in delimited text, a formatted cell in a workbook."""
    wall: datetime.datetime
    format: str


@dataclasses.dataclass
class Habits:
    """How a program writes its tables."""
    delimiter: str = ","
    decimal: str = "."
    thousands: str = ""
    trims_zeros: bool = False
    quotes_all: bool = False
    encoding: str = "utf-8"
    newline: str = "\n"
    space: str = " "  # between a clock time and AM or PM, and before a unit

    def number(self, number):
        text = f"{number.value:,.{number.decimals}f}" if self.thousands else f"{number.value:.{number.decimals}f}"
        if self.trims_zeros and "." in text:
            text = text.rstrip("0").rstrip(".")
        text = text.replace(",", "\0").replace(".", self.decimal).replace("\0", self.thousands)
        return text + (self.space + number.suffix if number.suffix else "")

    def moment(self, moment):
        text = moment.wall.strftime(moment.format)
        return text.replace(" AM", self.space + "AM").replace(" PM", self.space + "PM") if self.space != " " else text

    def text(self, cell):
        if isinstance(cell, Number):
            return self.number(cell)
        if isinstance(cell, Moment):
            return self.moment(cell)
        return "" if cell is None else str(cell)


def delimited(rows, habits):
    special = (habits.delimiter, '"', "\n", "\r")
    lines = []
    for row in rows:
        cells = [habits.text(cell) for cell in row]
        if habits.quotes_all:
            cells = ['"' + cell.replace('"', '""') + '"' for cell in cells]
        else:
            cells = ['"' + cell.replace('"', '""') + '"' if any(mark in cell for mark in special) else cell
                     for cell in cells]
        lines.append(habits.delimiter.join(cells))
    return (habits.newline.join(lines) + habits.newline).encode(habits.encoding)


def column_name(index):
    name = ""
    while index >= 0:
        index, letter = divmod(index, 26)
        name = chr(65 + letter) + name
        index -= 1
    return name


def sheet_xml(rows):
    out = ['<?xml version="1.0" encoding="UTF-8" standalone="yes"?><worksheet xmlns="http://schemas.openxmlformats.org/'
           'spreadsheetml/2006/main"><sheetData>']
    names = [column_name(i) for i in range(max(len(row) for row in rows))]
    for number, row in enumerate(rows, 1):
        out.append(f'<row r="{number}">')
        for name, cell in zip(names, row):
            where = f"{name}{number}"
            if isinstance(cell, Number) and not cell.suffix:
                out.append(f'<c r="{where}"><v>{cell.value:.{cell.decimals}f}</v></c>')
            elif isinstance(cell, Moment):
                since = cell.wall - datetime.datetime(1899, 12, 30)
                if not re.search("%-?[HI]", cell.format):
                    out.append(f'<c r="{where}" s="2"><v>{since.days}</v></c>')
                else:
                    out.append(f'<c r="{where}" s="1"><v>{since.days + since.seconds / 86400:.10f}</v></c>')
            elif cell not in (None, ""):
                text = Habits().text(cell)
                out.append(f'<c r="{where}" t="inlineStr"><is><t xml:space="preserve">{escape(text)}</t></is></c>')
        out.append("</row>")
    out.append("</sheetData></worksheet>")
    return "".join(out)


def workbook(sheets):
    """sheets: name -> rows, in order."""
    types = "application/vnd.openxmlformats-officedocument.spreadsheetml."
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    package = "http://schemas.openxmlformats.org/package/2006"
    count = len(sheets)
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{package}/content-types"><Default Extension="rels" ContentType='
        '"application/vnd.openxmlformats-package.relationships+xml"/><Override PartName="/xl/workbook.xml" ContentType='
        f'"{types}sheet.main+xml"/><Override PartName="/xl/styles.xml" ContentType="{types}styles+xml"/>' + "".join(
            f'<Override PartName="/xl/worksheets/sheet{i + 1}.xml" ContentType="{types}worksheet+xml"/>'
            for i in range(count)) + "</Types>",
        "_rels/.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="rId1" Type="{office}/'
        'officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets>' + "".join(
            f'<sheet name="{escape(name)}" sheetId="{i + 1}" r:id="rId{i + 1}"/>' for i, name in enumerate(sheets)) +
        "</sheets></workbook>",
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{package}/relationships">' + "".join(
            f'<Relationship Id="rId{i + 1}" Type="{office}/worksheet" Target="worksheets/sheet{i + 1}.xml"/>'
            for i in range(count)) +
        f'<Relationship Id="rId{count + 1}" Type="{office}/styles" Target="styles.xml"/></Relationships>',
        "xl/styles.xml": f'<styleSheet xmlns="{main}"><numFmts count="1"><numFmt numFmtId="164" formatCode="yyyy\\-mm'
        '\\-dd\\ hh:mm"/></numFmts><fonts count="1"><font/></fonts><fills count="1"><fill/></fills><borders count="1">'
        '<border/></borders><cellStyleXfs count="1"><xf/></cellStyleXfs><cellXfs count="3"><xf numFmtId="0"/><xf '
        'numFmtId="164" applyNumberFormat="1"/><xf numFmtId="14" applyNumberFormat="1"/></cellXfs></styleSheet>',
    }
    for i, rows in enumerate(sheets.values()):
        parts[f"xl/worksheets/sheet{i + 1}.xml"] = sheet_xml(rows)
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, text in parts.items():
            archive.writestr(zipfile.ZipInfo(name, (2025, 1, 1, 0, 0, 0)), text, compress_type=zipfile.ZIP_DEFLATED)
    return file.getvalue()
