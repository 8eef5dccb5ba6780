"""A scene with all that is there for writing by hand, and the one that it includes."""

BASE = """<ParameterList name="Scene">
  <Parameter name="Dimension" type="int" value="2"/>
  <ParameterList name="Constants">
    <Parameter name="n" type="int" value="8"/>
    <Parameter name="R" type="double" value="0.1"/>
    <Parameter name="gap" type="double" value="[1.5*R]"/>
  </ParameterList>
  <ParameterList name="Domain">
    <Parameter name="Cells" type="Array(int)" value="{[n], [n]}"/>
  </ParameterList>
  <ParameterList name="Defaults">
    <Parameter name="Friction" type="double" value="0.3"/>
  </ParameterList>
  <ParameterList name="Solids">
    <ParameterList name="Ball">
      <Parameter name="Type" type="string" value="rigid body"/>
      <ParameterList name="Geometry">
        <Parameter name="Shape" type="string" value="ball"/>
        <Parameter name="Radius" type="double" value="[R]"/>
      </ParameterList>
      <Parameter name="Density" type="double" value="[100*copy]"/>
      <ParameterList name="Copies">
        <Parameter name="Type" type="string" value="random"/>
        <Parameter name="Count" type="int" value="3"/>
        <Parameter name="Lower" type="Array(double)" value="{[gap], [gap]}"/>
        <Parameter name="Upper" type="Array(double)" value="{[1 - gap], [1 - gap]}"/>
        <ParameterList name="Overrides">
          <ParameterList name="2">
            <Parameter name="Density" type="double" value="8000"/>
          </ParameterList>
        </ParameterList>
      </ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Time">
    <Parameter name="Fixed Step" type="double" value="0.01"/>
    <Parameter name="Steps" type="int" value="2"/>
  </ParameterList>
</ParameterList>
"""

SCENE = """<ParameterList name="Scene">
  <Parameter name="Include" type="string" value="base.xml"/>
  <ParameterList name="Constants">
    <Parameter name="step" type="double" value="30"/>
  </ParameterList>
  <ParameterList name="Fluid">
    <Parameter name="Gravity" type="Array(double)" value="{0, -9.8}"/>
  </ParameterList>
  <ParameterList name="Solids">
    <ParameterList name="Ball">
      <ParameterList name="Copies">
        <ParameterList name="Overrides">
          <ParameterList name="3">
            <Parameter name="Density" type="double" value="[max(1, step*n)]"/>
          </ParameterList>
        </ParameterList>
      </ParameterList>
    </ParameterList>
  </ParameterList>
</ParameterList>
"""
