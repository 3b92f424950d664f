"""Small worlds for tests of datasets."""

from __future__ import annotations

from pathlib import Path

BALL = """<model name="{name}"><pose>{pose}</pose><link name="link">
  <visual name="ball"><geometry><sphere><radius>0.2</radius></sphere></geometry>
    <material><diffuse>0.8 0.1 0.1 1</diffuse></material></visual></link></model>"""
CRATE = """<model name="{name}"><pose>{pose}</pose><link name="link">
  <visual name="crate"><geometry><box><size>0.4 0.3 0.5</size></box></geometry></visual></link></model>"""
DRUMS = """<model name="drums"><static>true</static><link name="link">
  <visual name="blue"><pose>-1 1 0.4 0 0 0</pose>
    <geometry><cylinder><radius>0.2</radius><length>0.8</length></cylinder></geometry></visual>
  <visual name="lid"><pose>-1 1 0.81 0 0 0</pose>
    <geometry><cylinder><radius>0.2</radius><length>0.02</length></cylinder></geometry></visual>
  <visual name="green"><pose>-2 1 0.4 0 0 0</pose>
    <geometry><cylinder><radius>0.2</radius><length>0.8</length></cylinder></geometry></visual></link></model>"""
SIGN_MODEL = """<model name="sign"><link name="link">
  <visual name="pole"><pose>0 0 0.8 0 0 0</pose>
    <geometry><cylinder><radius>0.1</radius><length>1.6</length></cylinder></geometry></visual>
  <visual name="plate"><pose>-0.15 0 1.6 0 0 0</pose>
    <geometry><box><size>0.02 0.6 0.6</size></box></geometry></visual></link></model>"""
GROUND = """<model name="ground"><static>true</static><link name="link"><visual name="ground">
  <geometry><plane><normal>0 0 1</normal><size>50 50</size></plane></geometry></visual></link></model>"""
WALL = """<model name="wall"><static>true</static><link name="link"><visual name="wall"><pose>0 3 0.5 0 0 0</pose>
  <geometry><box><size>6 0.1 1</size></box></geometry></visual></link></model>"""


def world_text(*models: str) -> str:
    """Return a world of models."""
    return f'<sdf version="1.7"><world name="yard">{"".join(models)}</world></sdf>'


def write_yard(folder: Path) -> Path:
    """Write a world with two balls, a crate, drums, a wall and a ground."""
    path = folder / "yard.world"
    balls = BALL.format(name="red_ball", pose="1 0 0.2 0 0 0"), BALL.format(name="ball_2", pose="1 1 0.2 0 0 0")
    path.write_text(world_text(GROUND, WALL, *balls, CRATE.format(name="crate", pose="2 0 0.25 0 0 0"), DRUMS))
    return path
