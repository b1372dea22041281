"""Holds discovery messages against Home Assistant's own schemas.

    check_home_assistant.py MESSAGES.jsonl

Each line is {"topic", "payload"}; the states that entities refer to are among them. Ends with the
number of entities.
"""
import json
import sys

import jinja2
from homeassistant.components.mqtt import sensor
from homeassistant.components.mqtt.discovery import TOPIC_MATCHER
from homeassistant.components.sensor.const import DEVICE_CLASS_STATE_CLASSES, DEVICE_CLASS_UNITS

with open(sys.argv[1], encoding="utf-8") as lines:
    messages = {one["topic"]: one["payload"] for one in map(json.loads, lines)}

unique = set()
for topic, payload in messages.items():
    if not topic.startswith("homeassistant/"):
        continue
    match = TOPIC_MATCHER.match(topic.removeprefix("homeassistant/"))
    assert match and match.group("component") == "sensor", topic
    config = json.loads(payload)
    accepted = sensor.DISCOVERY_SCHEMA(dict(config))
    # The schema drops what it does not know.
    unknown = set(config) - set(map(str, accepted))
    assert not unknown, f"{topic}: {unknown}"
    device_class = config.get("device_class")
    if device_class:
        assert config["unit_of_measurement"] in DEVICE_CLASS_UNITS[device_class], topic
        assert config["state_class"] in DEVICE_CLASS_STATE_CLASSES[device_class], topic
    assert config["availability_topic"] in messages, topic
    state = json.loads(messages[config["state_topic"]])
    shown = jinja2.Template(config["value_template"], undefined=jinja2.StrictUndefined)
    shown.render(value_json=state)
    assert config["unique_id"] not in unique, topic
    unique.add(config["unique_id"])
print(len(unique))
