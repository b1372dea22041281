"""Tables of signature_table and the answers of their cases."""
import json
import pathlib


class Case:
    """A case, what its table says, and what is hidden in it."""

    def __init__(self, file, world, answer):
        self.table = json.loads(file.read_text())
        self.name, self.world, self.answer = file.stem, world, answer

    @property
    def hidden(self):
        return [effect["effect"] for effect in self.answer["effects"]]

    @property
    def share(self):
        """Of the meter moved most, by the strongest effect."""
        return max((value for effect in self.answer["effects"] for value in effect["moved_share"].values() if value is not None),
                   default=0.0)


def load(world, folders):
    """All cases without decoys: records that have one hold something that does not belong there.

    @param folders  TABLES:ANSWERS[,TABLES:ANSWERS …]; with :twins, nothing is hidden in them, and cases in which nothing is
                    hidden anyway are left out.
    """
    cases = []
    for tables, answers, *twins in (folder.split(":") for folder in folders.split(",")):
        for file in sorted(pathlib.Path(tables).glob("*.json")):
            answer = json.loads((pathlib.Path(answers) / file.name).read_text())
            if answer["decoys"] or (twins and not answer["effects"]):
                continue
            cases.append(Case(file, world, answer | {"effects": []} if twins else answer))
    return cases
